#include <algorithm>

#include "memo_hash.h"
#include "predicates_exact.h"

namespace nuvo {
namespace {

constexpr std::size_t kFirstEntries = 1024;
constexpr std::size_t kMostEntries = 1 << 16;  // 12 MB

// v by the power of two that brings its largest component to [1/2, 1): each component within two
// roundoffs, and what underflows.
Vector3 scaled_to_one(const ExactVector& v) {
    const WideDouble wide[3] = {v.x.approximate(), v.y.approximate(), v.z.approximate()};
    std::int64_t largest = std::numeric_limits<std::int64_t>::min();
    for (const WideDouble& c : wide)
        if (c.significand() != 0) largest = std::max(largest, c.exponent());
    Vector3 scaled;
    for (int axis = 0; axis < 3; ++axis) {
        const WideDouble& c = wide[axis];
        if (c.significand() != 0)
            scaled[axis] = WideDouble(c.significand(), c.exponent() - largest).rounded();
    }
    return scaled;
}

EdgePlanes planes_of(const Triangle& t, const Vector3& p, bool far) {
    const ExactVector corner[3] = {ExactVector(t.a), ExactVector(t.b), ExactVector(t.c)};
    const ExactVector shared(p);
    EdgePlanes planes;
    for (int i = 0; i < 3; ++i) {
        const ExactVector& from = corner[(i + 2) % 3];
        const ExactVector& to = corner[(i + 1) % 3];
        planes.normal[i] =
            scaled_to_one(far ? cross(to - from, shared) : cross(from - shared, to - shared));
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

const EdgePlanes* EdgeMemo::known_through(const Triangle& t, const Point3& p) const {
    if (entries_.empty()) return nullptr;
    const Entry& entry = entries_[detail::memo_hash(t, p, false) % entries_.size()];
    return entry.found && entry.is_for(t, p, false) ? &entry.planes : nullptr;
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
