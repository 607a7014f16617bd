#pragma once

#include "nuvo/math/vec.h"

/// Matrix3 in numbers of any kind. Internal to the predicates.
namespace nuvo::detail {

/// A 3 x 3 matrix by rows.
template <typename T>
struct Rows {
    Vec3<T> row[3];

    Vec3<T> column(int i) const { return {row[0][i], row[1][i], row[2][i]}; }
    Vec3<T> operator*(const Vec3<T>& v) const {
        return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
    }
    Rows transposed() const { return {{column(0), column(1), column(2)}}; }
};

/// Of the matrix with these rows: the transpose of the cofactors.
template <typename T>
Rows<T> adjugate_of(const Vec3<T>& r0, const Vec3<T>& r1, const Vec3<T>& r2) {
    return Rows<T>{{cross(r1, r2), cross(r2, r0), cross(r0, r1)}}.transposed();
}

}  // namespace nuvo::detail
