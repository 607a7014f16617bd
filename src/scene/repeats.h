#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "nuvo/scene/scene.h"

namespace nuvo::x3d {

/// Finds shapes that stand exactly where an earlier one stands. They are never seen, as of two hits
/// at equal distance the earlier wins, but each would cost every ray a test: a thousand USEs of a
/// sphere in one place are one sphere.
class Repeats {
  public:
    /// True when one of `objects` has the same surface as `shape`, to the last bit; else notes
    /// `shape` as the one that will be appended to `objects` next.
    bool is_repeat(const Shape& shape, const std::vector<Object>& objects);

  private:
    std::unordered_multimap<std::uint64_t, std::uint32_t> objects_;  // by a hash of the surface
};

}  // namespace nuvo::x3d
