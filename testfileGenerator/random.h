#pragma once

#include <cstdint>
#include <random>

namespace nuvo::generator {

/// A stream of numbers that is the same for the same seed on every platform: the standard fixes the
/// output of std::mt19937_64 but not that of its distributions, so the mapping to doubles is here.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// A multiple of 2^-53 in [0, 1).
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    /// A value in [-half, half).
    double symmetric(double half) { return (2 * unit() - 1) * half; }

  private:
    std::mt19937_64 engine_;
};

}  // namespace nuvo::generator
