#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "nuvo/math/vec.h"

namespace nuvo::hard {

/// What the numbers of a scene and its rays look like. Lattice: multiples of 1/64, so that aims are
/// exact; it and kFloat are float-exact input. kDouble: all 53 bits.
enum class Coordinates { kLattice, kFloat, kDouble };

/// The random choices of one batch: equal seeds give equal scenes and rays.
class Random {
  public:
    Random(std::uint64_t seed, Coordinates coordinates)
        : engine_(seed), coordinates_(coordinates) {}

    Coordinates coordinates() const { return coordinates_; }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    bool chance() { return below(2) == 0; }
    double sign() { return chance() ? 1 : -1; }
    /// 0 or -0.
    double zero() { return chance() ? 0.0 : -0.0; }
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    /// 10^x with x uniform: all sizes are as likely.
    double power_of_ten(double low, double high) { return std::pow(10, uniform(low, high)); }
    double signed_power_of_ten(double low, double high) {
        const double s = sign();
        return s * power_of_ten(low, high);
    }

    /// The nearest number that the input may hold: a float, or any double.
    double keep(double v) const {
        return coordinates_ == Coordinates::kDouble ? v
                                                    : static_cast<double>(static_cast<float>(v));
    }
    Vector3 keep(const Vector3& v) const { return {keep(v.x), keep(v.y), keep(v.z)}; }
    /// The same, on the lattice where there is one.
    double snap(double v) const {
        return coordinates_ == Coordinates::kLattice ? std::nearbyint(v * 64) / 64 : keep(v);
    }
    Vector3 snap(const Vector3& v) const { return {snap(v.x), snap(v.y), snap(v.z)}; }

    double coordinate(double half) { return snap(uniform(-half, half)); }
    Point3 point(double half) {
        const double x = coordinate(half);
        const double y = coordinate(half);
        return {x, y, coordinate(half)};
    }
    Vector3 unit() {
        for (;;) {
            const Vector3 v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            const double square = dot(v, v);
            if (square > 0.01 && square < 1) return normalized(v);
        }
    }

  private:
    std::mt19937_64 engine_;
    Coordinates coordinates_;
};

/// A seed for batch `batch` of class `index`, all bits mixed.
inline std::uint64_t mixed_seed(std::uint64_t seed, std::uint64_t index, std::uint64_t batch) {
    std::seed_seq sequence{seed & 0xffffffff, seed >> 32, index, batch & 0xffffffff, batch >> 32};
    std::uint32_t words[2];
    sequence.generate(words, words + 2);
    return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

}  // namespace nuvo::hard
