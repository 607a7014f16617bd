#pragma once

#include "nuvo/math/vec.h"

namespace nuvo {

/// A 3 x 3 matrix by rows.
struct Matrix3 {
    Vector3 row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    constexpr Vector3 column(int i) const { return {row[0][i], row[1][i], row[2][i]}; }
    constexpr Vector3 operator*(const Vector3& v) const {
        return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
    }
    constexpr Matrix3 operator*(const Matrix3& m) const {
        Matrix3 product;
        for (int i = 0; i < 3; ++i)
            product.row[i] = {dot(row[i], m.column(0)), dot(row[i], m.column(1)),
                              dot(row[i], m.column(2))};
        return product;
    }
    constexpr Matrix3 transposed() const { return {{column(0), column(1), column(2)}}; }
    /// The matrix of cofactors, transposed: m * m.adjugate() == determinant * identity.
    constexpr Matrix3 adjugate() const {
        const Matrix3 cofactors{
            {cross(row[1], row[2]), cross(row[2], row[0]), cross(row[0], row[1])}};
        return cofactors.transposed();
    }
    constexpr double determinant() const { return dot(row[0], cross(row[1], row[2])); }
    friend constexpr bool operator==(const Matrix3& a, const Matrix3& b) {
        return a.row[0] == b.row[0] && a.row[1] == b.row[1] && a.row[2] == b.row[2];
    }
};

/// p -> linear * p + translation.
struct Affine3 {
    Matrix3 linear;
    Vector3 translation;

    constexpr Point3 point(const Point3& p) const { return linear * p + translation; }
    constexpr Vector3 vector(const Vector3& v) const { return linear * v; }
    /// This transform after `inner`.
    constexpr Affine3 operator*(const Affine3& inner) const {
        return {linear * inner.linear, point(inner.translation)};
    }
};

/// Rotation about `axis` (any length but zero; a zero axis gives the identity) by `angle_rad`,
/// right-handed: Rodrigues' formula. [eq. 45, as corrected in docs/thesis-map.md]
Matrix3 rotation(const Vector3& axis, double angle_rad);

}  // namespace nuvo
