#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "nuvo/math/ray.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/scene.h"

namespace nuvo::hard {

/// How the program's answers compare with the oracle's.
struct Tally {
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;  ///< by the oracle
    std::uint64_t missed = 0;
    std::uint64_t false_hits = 0;
    std::uint64_t wrong_primitive = 0;  ///< at another t than the nearest
    std::uint64_t wrong_apart = 0;      ///< of those, t further apart than 1e-14
    std::uint64_t tie_breaks = 0;       ///< the nearest t, but not the first in document order
    double worst_t = 0;                 ///< relative error of t
    double worst_t_tangent = 0;         ///< the same within 1e-6 R of tangency

    Tally& operator+=(const Tally& other);
    /// What has to hold; `float_exact`: no wrong primitive at all.
    bool right(bool float_exact) const;
};

/// A class's tallies for float-exact and for full-double input.
struct ClassTally {
    std::string name;
    Tally float_exact;
    Tally full_double;
};

struct RunOptions {
    std::uint64_t rays = 1'000'000;
    std::uint64_t seed = 1;
    std::string only;                         ///< a class; empty: all of them, in equal parts
    unsigned threads = 0;                     ///< 0: as many as the machine has
    Precision precision = Precision::kExact;  ///< the others, to show that errors are found
    int rays_per_scene = 400;
    bool solid = false;  ///< of every other object only the front is there
    bool fast = false;   ///< the fast tracer's single rays, with each instruction set in turn
};

/// Compares one scene's answers; each that is wrong is printed with its numbers.
Tally judge(const Scene& scene, std::span<const Ray> rays, std::span<const RayAnswer> answers,
            const std::string& label, std::ostream& faults);

/// Runs the classes. Empty where `only` names none.
std::vector<ClassTally> run(const RunOptions& options, std::ostream& faults);

/// The table; true when every class is right.
bool print(std::ostream& out, const std::vector<ClassTally>& tallies);

}  // namespace nuvo::hard
