#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nuvo::generator {

/// The numbers that rand() of the GNU C library gives without srand(), restated so that they are
/// the same on every platform: an additive feedback generator over the last 31 words, filled from a
/// linear congruential one with seed 1 and run 310 times before the first number.
class GlibcRand {
  public:
    GlibcRand() {
        std::uint64_t word = 1;
        for (std::size_t i = 0; i < kDegree; ++i) {
            words_[i] = static_cast<std::uint32_t>(word);
            word = word * 16807 % 2147483647;
        }
        // Words 31 to 33 repeat words 0 to 2; then the feedback starts.
        oldest_ = 3;
        for (int i = 0; i < kDiscarded; ++i) step();
    }

    /// A whole number from 0 to 2^31 - 1.
    int operator()() { return static_cast<int>(step() >> 1); }

  private:
    static constexpr std::size_t kDegree = 31;
    static constexpr std::size_t kLag = 3;
    static constexpr int kDiscarded = 310;

    // words_ is a ring: word k stands at k % 31, where word k - 31 stood.
    std::uint32_t step() {
        std::uint32_t& word = words_[oldest_];
        word += words_[(oldest_ + kDegree - kLag) % kDegree];
        oldest_ = (oldest_ + 1) % kDegree;
        return word;
    }

    std::array<std::uint32_t, kDegree> words_{};
    std::size_t oldest_ = 0;
};

}  // namespace nuvo::generator
