#include <algorithm>

#include "memo_hash.h"
#include "predicates_exact.h"

namespace nuvo {
namespace {

constexpr std::size_t kFirstEntries = 1024;
constexpr std::size_t kMostEntries = 1 << 16;  // 12 MB

// The power of two that brings v's largest component to [1/2, 1); 0 for a zero.
std::int64_t exponent_of(const Vec3<WideDouble>& v) {
    std::int64_t largest = std::numeric_limits<std::int64_t>::min();
    for (const WideDouble& c : {v.x, v.y, v.z})
        if (c.significand() != 0) largest = std::max(largest, c.exponent());
    return largest == std::numeric_limits<std::int64_t>::min() ? 0 : largest;
}

// x / 2^exponent, rounded.
double scaled(const WideDouble& x, std::int64_t exponent) {
    return x.significand() == 0 ? 0
                                : WideDouble(x.significand(), x.exponent() - exponent).rounded();
}

EdgePlanes planes_of(const Triangle& t, const Vector3& p, bool far) {
    const ExactVector corner[3] = {ExactVector(t.a), ExactVector(t.b), ExactVector(t.c)};
    const ExactVector shared(p);
    EdgePlanes planes;
    for (int i = 0; i < 3; ++i) {
        const ExactVector& from = corner[(i + 2) % 3];
        const ExactVector& to = corner[(i + 1) % 3];
        const ExactVector normal =
            far ? cross(to - from, shared) : cross(from - shared, to - shared);
        const Vec3<WideDouble> wide{normal.x.approximate(), normal.y.approximate(),
                                    normal.z.approximate()};
        const std::int64_t exponent = exponent_of(wide);
        for (int axis = 0; axis < 3; ++axis) planes.normal[i][axis] = scaled(wide[axis], exponent);
        if (far) planes.offset[i] = scaled(dot(normal, to).approximate(), exponent);
    }
    return planes;
}

}  // namespace

EdgePlanes edge_planes_through(const Triangle& triangle, const Point3& p) {
    return planes_of(triangle, p, false);
}

bool EdgeMemo::Entry::is_for(const Triangle& t, const Vector3& q, bool is_far) const {
    return used && far == is_far && p == q && detail::same(triangle, t);
}

const EdgePlanes* EdgeMemo::through(const Triangle& triangle, const Point3& p) {
    return find(triangle, p, false);
}

const EdgePlanes* EdgeMemo::known(const Triangle& t, const Vector3& p, bool far) const {
    if (entries_.empty()) return nullptr;
    const Entry& entry = entries_[detail::memo_hash(t, p, far) % entries_.size()];
    return entry.found && entry.is_for(t, p, far) ? &entry.planes : nullptr;
}

const EdgePlanes* EdgeMemo::along(const Triangle& triangle, const Vector3& d) {
    return find(triangle, d, true);
}

const EdgePlanes* EdgeMemo::find(const Triangle& t, const Vector3& p, bool far) {
    if (entries_.empty()) entries_.resize(kFirstEntries);
    if (lost_ > entries_.size() && entries_.size() < kMostEntries) {
        const std::size_t size = 2 * entries_.size();
        entries_.assign(size, {});
        lost_ = 0;
    }
    Entry& entry = entries_[detail::memo_hash(t, p, far) % entries_.size()];
    if (!entry.is_for(t, p, far)) {
        if (entry.found) ++lost_;
        entry = {t, p, far, true, false, {}};
        return nullptr;
    }
    if (!entry.found) entry.planes = planes_of(t, p, far);
    entry.found = true;
    return &entry.planes;
}

}  // namespace nuvo
