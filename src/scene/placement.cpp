#include "placement.h"

namespace nuvo::x3d {

namespace {

Matrix3 diagonal(const Vector3& v) { return {{{v.x, 0, 0}, {0, v.y, 0}, {0, 0, v.z}}}; }

double largest_entry(const Matrix3& m) {
    return std::fmax(max_norm(m.row[0]), std::fmax(max_norm(m.row[1]), max_norm(m.row[2])));
}

}  // namespace

Placement Placement::inside(const Fields& transform) const {
    const Vector3 translation = transform.vector("translation", {});
    const Vector3 center = transform.vector("center", {});
    const Vector3 scale = transform.vector("scale", {1, 1, 1});
    const Matrix3 rotation = transform.rotation("rotation");
    const Matrix3 orientation = transform.rotation("scaleOrientation");

    // Turning before and after an equal scale changes nothing: left out, it rounds nothing either.
    const bool equal = scale.x == scale.y && scale.y == scale.z;
    const Matrix3 scaling =
        equal ? diagonal(scale) : orientation * diagonal(scale) * orientation.transposed();
    Affine3 local;
    local.linear = rotation * scaling;
    local.translation = translation + (center - local.linear * center);

    Placement inner;
    inner.to_world = to_world * local;
    const Vector3 size{std::fabs(scale.x), std::fabs(scale.y), std::fabs(scale.z)};
    const bool same_size = size.x == size.y && size.y == size.z;
    inner.uniform = uniform && same_size;
    inner.mirrored = mirrored != ((scale.x < 0) != ((scale.y < 0) != (scale.z < 0)));
    inner.singular = singular || size.x == 0 || size.y == 0 || size.z == 0;
    inner.turn = turn * rotation;
    inner.length_scale =
        length_scale *
        (same_size ? size.x : std::cbrt(size.x) * std::cbrt(size.y) * std::cbrt(size.z));
    return inner;
}

Placement Placement::scaled(double factor) const {
    if (factor == 1) return *this;
    Placement inner = *this;
    inner.to_world = to_world * Affine3{diagonal({factor, factor, factor}), {}};
    inner.length_scale = length_scale * factor;
    return inner;
}

Vector3 Placement::normal(const Vector3& local) const {
    if (to_world.linear == Matrix3{}) return normalized(local);
    // Scaled to entries of at most 1, so that the cofactors neither overflow nor vanish.
    Matrix3 m = to_world.linear;
    const double largest = largest_entry(m);
    for (Vector3& row : m.row) row = row / largest;
    const Matrix3 cofactors = m.adjugate().transposed();
    const Vector3 world = normalized(cofactors * local);
    return mirrored ? -world : world;
}

}  // namespace nuvo::x3d
