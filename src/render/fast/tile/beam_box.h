#pragma once

namespace nuvo {

/// A set of rays o + t d in the local frame: o and d in closed boxes, 0 <= t <= t_end.
struct BeamBox {
    float origin_low[3];
    float origin_high[3];
    float direction_low[3];   ///< never 0: see keep_off_zero()
    float direction_high[3];  ///< never 0
    float t_end;
    bool far_first = false;  ///< leaves are visited from the far end on

    bool straddles() const {
        return (direction_low[0] < 0 && direction_high[0] > 0) ||
               (direction_low[1] < 0 && direction_high[1] > 0) ||
               (direction_low[2] < 0 && direction_high[2] > 0);
    }
    /// Grows the directions so that their bounds have inverses in the range of floats.
    void keep_off_zero() {
        constexpr float kSmallest = 0x1p-100F;
        for (int axis = 0; axis < 3; ++axis) {
            float& low = direction_low[axis];
            float& high = direction_high[axis];
            if (-kSmallest < low && low < kSmallest) low = -kSmallest;
            if (-kSmallest < high && high < kSmallest) high = kSmallest;
        }
    }
};

}  // namespace nuvo
