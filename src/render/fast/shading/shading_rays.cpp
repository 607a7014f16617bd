#include "fast/shading/shading_rays.h"

#include <algorithm>
#include <cmath>

#include "fast/shading/shading_tables.h"
#include "fast/simd/estimate_error.h"

namespace nuvo {
namespace {

std::size_t whole_tiles(int pixels) {
    return static_cast<std::size_t>((pixels + kTileSide - 1) / kTileSide * kTileSide);
}

void add(const Vector3& v, std::vector<float> (&out)[3]) {
    for (int axis = 0; axis < 3; ++axis) out[axis].push_back(static_cast<float>(v[axis]));
}

double largest_step(const std::vector<float>& parts) {
    double most = 0;
    for (const float part : parts) most = std::max(most, std::fabs(static_cast<double>(part)));
    return most;
}

}  // namespace

ShadingRays::ShadingRays(const CameraRays& camera, const Vector3& zenith) {
    const Resolution size = camera.resolution;
    const std::size_t width = whole_tiles(size.width);
    const std::size_t height = whole_tiles(size.height) * kBlockSide;
    const auto of_column = [&](const Vector3& step, std::size_t x) {
        return step * camera.center_x(static_cast<int>(x));
    };
    const auto of_row = [&](const Vector3& first, const Vector3& step, std::size_t i) {
        return first + step * camera.center_y(static_cast<int>(i / kBlockSide));
    };
    // Of directions.
    const Vector3 right = camera.parallel ? Vector3{} : camera.right;
    const Vector3 down = camera.parallel ? Vector3{} : camera.down;
    for (std::size_t x = 0; x < width; ++x) {
        const Vector3 part = of_column(right, x);
        add(part, column);
        column_height.push_back(static_cast<float>(dot(part, zenith)));
        column_square.push_back(static_cast<float>(dot(part, part)));
        if (camera.parallel) add(of_column(camera.right, x), start_column);
    }
    for (std::size_t i = 0; i < height; ++i) {
        const Vector3 part = of_row(camera.forward, down, i);
        add(part, row);
        row_height.push_back(static_cast<float>(dot(part, zenith)));
        row_square.push_back(static_cast<float>(dot(part, part)));
        if (camera.parallel) add(of_row(camera.origin, camera.down, i), start_row);
    }
    if (camera.parallel) {
        double farthest = 0;
        for (int axis = 0; axis < 3; ++axis)
            farthest += largest_step(start_column[axis]) + largest_step(start_row[axis]);
        // Both parts' and their sum's.
        start_error = rounded_up(roundings(2) * farthest + 3 * camera.start_error);
    }

    // The longest column's part, row's part and sum; |forward| is 1 up to its roundings in double.
    const double across = nuvo::length(right) * 0.5 * size.width;
    const double along = 1 + nuvo::length(down) * 0.5 * size.height;
    // The sum of perpendicular parts a, b is at least (|a| + |b|) / sqrt(2).
    longest = rounded_up(kSlack * std::sqrt(across * across + along * along));
    error = rounded_up(roundings(1) * (across + along + static_cast<double>(longest)));
    relative = roundings(std::sqrt(2.0) + 1);
    // d.z: roundings of its parts and their sum, |d| >= 1; then of y = d.z / |d| the roundings of
    // the parts of |d|^2 and of their sum by half (1), the root's and the product's. And what
    // the axes lack of being perpendicular.
    const double parts = largest_step(column_height) + largest_step(row_height);
    const double y = std::min(1.0, parts);
    const double skew = std::fabs(dot(right, camera.forward)) * 0.5 * size.width +
                        std::fabs(dot(right, down)) * 0.25 * size.width * size.height;
    sine_error = rounded_up(roundings(1) * (parts + 3 * y) + kInverseSqrtError * y + kSlack * skew);
}

std::size_t ShadingRays::memory_bytes() const {
    std::size_t bytes = vector_bytes(column_height) + vector_bytes(row_height) +
                        vector_bytes(column_square) + vector_bytes(row_square);
    for (int axis = 0; axis < 3; ++axis)
        bytes += vector_bytes(column[axis]) + vector_bytes(row[axis]) +
                 vector_bytes(start_column[axis]) + vector_bytes(start_row[axis]);
    return bytes;
}

}  // namespace nuvo
