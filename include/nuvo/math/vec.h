#pragma once

#include <cmath>

namespace nuvo {

/// A pair of values, e.g. barycentric coordinates or a pixel. [thesis 5.1]
template <typename T>
struct Vec2 {
    T x{};
    T y{};

    friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

/// Three values: a point, a vector or a colour. Operations are componentwise and are carried out
/// in the order written here, so equal inputs give equal bits everywhere. [thesis 5.1, eq. 6-9]
template <typename T>
struct Vec3 {
    T x{};
    T y{};
    T z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_in, T y_in, T z_in) : x(x_in), y(y_in), z(z_in) {}
    /// Converts each component (rounding to nearest where U is wider than T).
    template <typename U>
    explicit constexpr Vec3(const Vec3<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3& operator+=(const Vec3& v) { return *this = *this + v; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) {
        return {a.x * b.x, a.y * b.y, a.z * b.z};
    }
    friend constexpr Vec3 operator*(const Vec3& v, T s) { return {v.x * s, v.y * s, v.z * s}; }
    friend constexpr Vec3 operator*(T s, const Vec3& v) { return v * s; }
    friend constexpr Vec3 operator/(const Vec3& v, T s) { return {v.x / s, v.y / s, v.z / s}; }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Point3 = Vec3<double>;
using Vector3 = Vec3<double>;
using Color = Vec3<double>;  ///< red, green, blue; 0..1 is the displayable range

/// a . b [eq. 6]
template <typename T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// a x b [eq. 8]
template <typename T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The components' absolute values.
template <typename T>
Vec3<T> magnitude(const Vec3<T>& v) {
    return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}

/// |a| x |b| with the products added, which bounds the roundings of a x b.
template <typename T>
Vec3<T> cross_magnitude(const Vec3<T>& a, const Vec3<T>& b) {
    const Vec3<T> s = magnitude(a);
    const Vec3<T> t = magnitude(b);
    return {s.y * t.z + s.z * t.y, s.z * t.x + s.x * t.z, s.x * t.y + s.y * t.x};
}

/// The sum of the absolute components.
template <typename T>
T norm1(const Vec3<T>& v) {
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

/// Largest absolute component; a NaN may be lost. (Comparisons compile to one
/// instruction each, std::fmax to a call.)
template <typename T>
T max_norm(const Vec3<T>& v) {
    const T x = std::fabs(v.x);
    const T y = std::fabs(v.y);
    const T z = std::fabs(v.z);
    const T xy = x > y ? x : y;
    return xy > z ? xy : z;
}

/// Euclidean length. Scaled by the largest component first, so that it neither overflows nor
/// underflows where the result itself does not.
template <typename T>
T length(const Vec3<T>& v) {
    const T largest = max_norm(v);
    if (!(largest > 0) || std::isinf(largest)) return largest;
    const Vec3<T> scaled = v / largest;
    return largest * std::sqrt(dot(scaled, scaled));
}

/// Unit vector along v; the zero vector stays zero. [eq. 9]
template <typename T>
Vec3<T> normalized(const Vec3<T>& v) {
    const T largest = max_norm(v);
    if (!(largest > 0)) return {};
    const Vec3<T> scaled = v / largest;
    return scaled / std::sqrt(dot(scaled, scaled));
}

/// Componentwise minimum and maximum.
template <typename T>
constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
    return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
template <typename T>
constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y, a.z < b.z ? b.z : a.z};
}

}  // namespace nuvo
