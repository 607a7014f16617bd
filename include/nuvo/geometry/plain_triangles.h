#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "nuvo/geometry/plain_tests.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/big_vector.h"

namespace nuvo::plain {

/// The corners of one triangle.
template <typename T>
struct Corners {
    Vec3<T> a, b, c;
};

/// A list of triangles. Where runs of them are tested it also keeps them by columns, so that
/// several tests run side by side in one register: a first pass without branches finds candidates
/// with the operations of hit(), which then decides them.
template <typename T>
class Triangles {
  public:
    explicit Triangles(bool in_runs) : in_runs_(in_runs) {}

    void push_back(const Triangle& triangle) {
        corners_.push_back({Vec3<T>(triangle.a), Vec3<T>(triangle.b), Vec3<T>(triangle.c)});
        if (!in_runs_) return;
        const Corners<T>& c = corners_.back();
        const Vec3<T> corner[3] = {c.a, c.b, c.c};
        for (std::size_t i = 0; i < 9; ++i)
            columns_[i].push_back(corner[i / 3][static_cast<int>(i % 3)]);
    }
    std::size_t size() const { return corners_.size(); }
    std::size_t memory_bytes() const {
        std::size_t bytes = vector_bytes(corners_);
        for (const auto& column : columns_) bytes += vector_bytes(column);
        return bytes;
    }
    const Corners<T>& operator[](std::size_t i) const { return corners_[i]; }

    /// Calls `use(i, hit)` for each triangle of [first, last) that the ray hits, in order.
    template <typename Use>
    void for_each_hit(const RayT<T>& ray, std::size_t first, std::size_t last, Use&& use) const {
        const auto decide = [&](std::size_t i) {
            const Corners<T>& c = corners_[i];
            if (const std::optional<Hit<T>> found = hit(ray, c.a, c.b, c.c)) use(i, *found);
        };
        if (!in_runs_) {
            for (; first < last; ++first) decide(first);
            return;
        }
        std::uint8_t candidate[kBlock];
        for (; first < last; first += kBlock) {
            const std::size_t count = std::min(kBlock, last - first);
            if (!find_candidates(ray, first, count, candidate)) continue;
            for (std::size_t i = 0; i < count; ++i)
                if (candidate[i]) decide(first + i);
        }
    }

  private:
    static constexpr std::size_t kBlock = 64;

    // Moeller and Trumbore's tests of u and v, column by column.
    bool find_candidates(const RayT<T>& ray, std::size_t first, std::size_t count,
                         std::uint8_t* candidate) const {
        const T* const ax = columns_[0].data() + first;
        const T* const ay = columns_[1].data() + first;
        const T* const az = columns_[2].data() + first;
        const T* const bx = columns_[3].data() + first;
        const T* const by = columns_[4].data() + first;
        const T* const bz = columns_[5].data() + first;
        const T* const cx = columns_[6].data() + first;
        const T* const cy = columns_[7].data() + first;
        const T* const cz = columns_[8].data() + first;
        std::uint8_t any = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3<T> a{ax[i], ay[i], az[i]};
            const Vec3<T> e1 = Vec3<T>{bx[i], by[i], bz[i]} - a;
            const Vec3<T> e2 = Vec3<T>{cx[i], cy[i], cz[i]} - a;
            const Vec3<T> p = cross(ray.direction, e2);
            const Vec3<T> s = ray.origin - a;
            const Vec3<T> q = cross(s, e1);
            const T determinant = dot(e1, p);
            const T side = determinant < 0 ? T(-1) : T(1);
            const T size = determinant * side;
            const T u = dot(s, p) * side;
            const T v = dot(ray.direction, q) * side;
            candidate[i] =
                static_cast<std::uint8_t>((u >= 0) & (u <= size) & (v >= 0) & (u + v <= size));
            any = static_cast<std::uint8_t>(any | candidate[i]);
        }
        return any != 0;
    }

    bool in_runs_;
    std::vector<Corners<T>> corners_;
    std::vector<T> columns_[9];  // a.x, a.y, a.z, b.x .. c.z
};

}  // namespace nuvo::plain
