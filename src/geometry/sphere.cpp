#include "nuvo/geometry/sphere.h"

#include "rounding.h"

namespace nuvo {

Bounds3 Sphere::bounds() const {
    return {{subtract_down(center.x, radius), subtract_down(center.y, radius),
             subtract_down(center.z, radius)},
            {add_up(center.x, radius), add_up(center.y, radius), add_up(center.z, radius)}};
}

}  // namespace nuvo
