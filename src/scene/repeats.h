#pragma once

#include <cstdint>
#include <vector>

#include "nuvo/scene/scene.h"

namespace nuvo::x3d {

/// Finds shapes that stand exactly where an earlier one stands. They are never seen, as of two hits
/// at equal distance the earlier wins, but each would cost every ray a test: a thousand USEs of a
/// sphere in one place are one sphere. One whose back is seen, or which casts a shadow, is hidden
/// by its like only.
class Repeats {
  public:
    /// True when one of `objects` has the same surface as `object`, to the last bit; else notes
    /// `object` as the one that will be appended to `objects` next.
    bool is_repeat(const Object& object, const std::vector<Object>& objects);

  private:
    struct Slot {
        std::uint64_t hash = 0;
        std::uint32_t object = kFree;
    };
    static constexpr std::uint32_t kFree = ~std::uint32_t{0};

    void insert(Slot slot);

    // A hash table with open addressing: slots of one hash follow each other from hash % size on.
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

}  // namespace nuvo::x3d
