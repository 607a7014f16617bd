#pragma once

#include <cstdint>
#include <vector>

#include "fast/scene/fast_scene.h"

namespace nuvo {

/// Two primitives, and a light where the answer depends on one.
struct SlotPair {
    Slot first = kNoSlot;
    Slot second = kNoSlot;
    std::uint32_t light = 0;
    bool operator==(const SlotPair&) const = default;
};

/// Answers that were found for pairs, direct mapped: a pair takes the place of an older one. Holds
/// no memory before it is first asked, and more as more is found. For one thread.
template <typename Answer>
class PairCache {
  public:
    /// The answer for `pair`: as kept, or as `find()` gives it.
    template <typename Find>
    Answer of(const SlotPair& pair, Find&& find) {
        if (entries_.empty()) entries_.resize(std::size_t{1} << log2_entries_);
        const std::uint32_t hash =
            pair.first * 0x9e3779b1U + pair.second * 0x85ebca6bU + pair.light * 0xc2b2ae35U;
        Entry& entry = entries_[hash >> (32 - log2_entries_)];
        if (entry.pair == pair) return entry.answer;
        const Answer answer = find();
        entry = {pair, answer};
        if (++found_ > entries_.size() && log2_entries_ < kLog2Most) grow();
        return answer;
    }

  private:
    static constexpr unsigned kLog2Least = 12;
    static constexpr unsigned kLog2Most = 18;  // 4 MB
    struct Entry {
        SlotPair pair;
        Answer answer{};
    };
    // What was found so far is found again, which takes no longer than it did.
    void grow() {
        entries_.assign(std::size_t{1} << ++log2_entries_, Entry{});
        found_ = 0;
    }

    std::vector<Entry> entries_;
    unsigned log2_entries_ = kLog2Least;
    std::size_t found_ = 0;  // since it grew
};

}  // namespace nuvo
