#pragma once

#include <bit>

#include "nuvo/geometry/triangle_mesh.h"

/// Keys of what is kept for a triangle and a point or direction. Internal to the predicates.
namespace nuvo::detail {

/// Mixes a double into a hash (multiplication by an odd number close to 2^64 / golden ratio).
inline std::uint64_t mixed(std::uint64_t hash, double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15;
    return hash ^ (hash >> 32);
}
inline std::uint64_t mixed(std::uint64_t hash, const Point3& p) {
    return mixed(mixed(mixed(hash, p.x), p.y), p.z);
}
/// `far`: p is a direction.
inline std::uint64_t memo_hash(const Triangle& t, const Vector3& p, bool far) {
    return mixed(mixed(mixed(mixed(far ? 1 : 0, t.a), t.b), t.c), p);
}

inline bool same(const Triangle& s, const Triangle& t) {
    return s.a == t.a && s.b == t.b && s.c == t.c;
}

}  // namespace nuvo::detail
