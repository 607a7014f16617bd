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
/// no memory before it is first asked. For one thread.
template <typename Answer>
class PairCache {
  public:
    /// The answer for `pair`: as kept, or as `find()` gives it.
    template <typename Find>
    Answer of(const SlotPair& pair, Find&& find) {
        if (entries_.empty()) entries_.resize(std::size_t{1} << kLog2Entries);
        const std::uint32_t hash =
            pair.first * 0x9e3779b1U + pair.second * 0x85ebca6bU + pair.light * 0xc2b2ae35U;
        Entry& entry = entries_[hash >> (32 - kLog2Entries)];
        if (entry.pair != pair) entry = {pair, find()};
        return entry.answer;
    }

  private:
    static constexpr unsigned kLog2Entries = 14;
    struct Entry {
        SlotPair pair;
        Answer answer{};
    };
    std::vector<Entry> entries_;
};

}  // namespace nuvo
