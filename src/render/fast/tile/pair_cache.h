#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
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

/// Answers that were found for pairs: a hash table with linear probing, at most half full. Holds no
/// memory before it is first asked, and starts anew when it would outgrow a cache. For one thread.
template <typename Answer>
class PairCache {
  public:
    /// The answer for `pair`: as kept, or as `find()` gives it.
    template <typename Find>
    Answer of(const SlotPair& pair, Find&& find) {
        if (2 * count_ >= entries_.size()) make_room();
        Entry& entry = place_of(pair);
        if (entry.pair.first == kNoSlot) {
            entry = {pair, find()};
            ++count_;
        }
        return entry.answer;
    }

    std::size_t memory_bytes() const { return vector_bytes(entries_); }

  private:
    static constexpr std::size_t kLeast = std::size_t{1} << 10;
    static constexpr std::size_t kMost = std::size_t{1} << 18;  // 4 to 7 MB
    struct Entry {
        SlotPair pair;  // first is kNoSlot: free
        Answer answer{};
    };

    /// Where the pair stands, or the free place for it.
    Entry& place_of(const SlotPair& pair) {
        std::uint32_t hash =
            pair.first * 0x9e3779b1U + pair.second * 0x85ebca6bU + pair.light * 0xc2b2ae35U;
        hash ^= hash >> 15;
        const std::size_t mask = entries_.size() - 1;
        std::size_t at = hash & mask;
        while (entries_[at].pair.first != kNoSlot && entries_[at].pair != pair)
            at = (at + 1) & mask;
        return entries_[at];
    }
    void make_room() {
        if (entries_.size() == kMost) {
            entries_.assign(kMost, Entry{});
            count_ = 0;
            return;
        }
        const std::vector<Entry> old =
            std::exchange(entries_, std::vector<Entry>(std::max(kLeast, 2 * entries_.size())));
        for (const Entry& entry : old)
            if (entry.pair.first != kNoSlot) place_of(entry.pair) = entry;
    }

    std::vector<Entry> entries_;  // a power of two
    std::size_t count_ = 0;
};

}  // namespace nuvo
