#pragma once

#include <cstdint>
#include <iosfwd>

namespace nuvo::hard {

struct LeakCount {
    std::uint64_t rays = 0;
    std::uint64_t leaks = 0;  ///< rays that left a closed mesh without a hit
};

/// Rays from inside closed meshes at their corners and at points of their edges. No oracle: such a
/// ray must hit. Each leak is printed with its numbers.
LeakCount count_leaks(std::uint64_t rays, std::uint64_t seed, unsigned threads,
                      std::ostream& faults);

}  // namespace nuvo::hard
