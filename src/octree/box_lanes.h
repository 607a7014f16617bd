#pragma once

#include <cstdint>
#include <cstring>

#include "nuvo/math/bounds.h"
#include "nuvo/math/four.h"

namespace nuvo {

inline Four four(const Vec3<float>& v) { return Four{v.x, v.y, v.z, 0}; }

/// A box: the last lanes hold anything.
struct BoxInFours {
    explicit BoxInFours(const Bounds3T<float>& box) {
        static_assert(sizeof(Bounds3T<float>) == 6 * sizeof(float));
        std::memcpy(&low, &box.min.x, sizeof(Four));
        std::memcpy(&high, &box.min.z, sizeof(Four));
        high = __builtin_shufflevector(high, high, 1, 2, 3, 0);
    }
    Four low;
    Four high;
};

/// Which sides of a voxel's three planes boxes touch: bit 0, 1, 2 the lower sides, 3, 4, 5 the
/// upper.
class SidesOfPlanes {
  public:
    explicit SidesOfPlanes(const Vec3<float>& planes)
        : planes_(four(planes)), planes_later_{0, planes.x, planes.y, planes.z} {}

    std::uint32_t of(const Bounds3T<float>& box) const {
        Four low;
        Four high;  // of the lanes 1 to 3
        std::memcpy(&low, &box.min.x, sizeof(Four));
        std::memcpy(&high, &box.min.z, sizeof(Four));
        const FourInts bits = ((low <= planes_) & FourInts{1, 2, 4, 0}) |
                              ((high >= planes_later_) & FourInts{0, 8, 16, 32});
        const FourInts halves = bits | __builtin_shufflevector(bits, bits, 2, 3, 0, 1);
        std::uint64_t both;
        std::memcpy(&both, &halves, sizeof both);
        return static_cast<std::uint32_t>(both | both >> 32);
    }

  private:
    Four planes_;
    Four planes_later_;
};

}  // namespace nuvo
