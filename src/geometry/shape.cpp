#include "nuvo/geometry/shape.h"

namespace nuvo {

Bounds3 bounds(const Shape& shape) {
    return std::visit([](const auto& s) { return s.bounds(); }, shape);
}

}  // namespace nuvo
