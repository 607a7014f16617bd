#pragma once

#include <random>
#include <vector>

#include "nuvo/math/bounds.h"

namespace nuvo {

/// Cubes of `size` with their least corners anywhere in [0, 100]^3.
inline std::vector<Bounds3> random_boxes(unsigned seed, std::size_t count, double size) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0, 100);
    std::vector<Bounds3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 p{place(random), place(random), place(random)};
        boxes.push_back({p, p + Vector3{size, size, size}});
    }
    return boxes;
}

}  // namespace nuvo
