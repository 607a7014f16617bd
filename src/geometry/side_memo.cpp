#include "memo_hash.h"
#include "plane_root.h"
#include "predicates_exact.h"

namespace nuvo {
namespace {

constexpr std::size_t kEntries = 4096;  // 400 kB; a power of two

// n.(a - p), or -n.p where p is a direction.
template <typename T>
detail::Bounded<T> rounded_side(const Triangle& t, const Vector3& p, bool far) {
    const Vec3<T> a(t.a);
    const Vec3<T> e1 = Vec3<T>(t.b) - a;
    const Vec3<T> e2 = Vec3<T>(t.c) - a;
    return detail::triple_product(far ? -Vec3<T>(p) : a - Vec3<T>(p), cross(e1, e2),
                                  detail::cross_magnitude(e1, e2));
}

std::optional<int> sure_side(const Triangle& t, const Vector3& p, bool far) {
    const detail::Bounded<double> cheap = rounded_side<double>(t, p, far);
    if (cheap.sure()) return cheap.sign();
    const detail::Bounded<long double> wider = rounded_side<long double>(t, p, far);
    if (wider.sure()) return wider.sign();
    if (wider.vanishes()) return 0;
    return std::nullopt;
}

}  // namespace

int exact_side(const Triangle& t, const Vector3& p, bool far) {
    const ExactVector a(t.a);
    const ExactVector normal = cross(ExactVector(t.b) - a, ExactVector(t.c) - a);
    return dot(normal, far ? ExactVector(-p) : a - ExactVector(p)).sign();
}

int SideMemo::kept_side(const Triangle& t, const Vector3& p, bool far, std::uint64_t& exact) {
    // An empty entry's triangle has no area, and is not asked about.
    if (entries_.empty()) entries_.resize(kEntries);
    Entry& entry = entries_[detail::memo_hash(t, p, far) % kEntries];
    if (!detail::same(entry.triangle, t) || !(entry.p == p) || entry.far != far) {
        ++exact;
        entry = {t, p, far, exact_side(t, p, far)};
    }
    return entry.sign;
}

int SideMemo::side(const Triangle& triangle, const Point3& p, std::uint64_t& exact) {
    if (detail::is_corner(p, triangle)) return 0;
    if (const std::optional<int> sign = sure_side(triangle, p, false)) return *sign;
    return kept_side(triangle, p, false, exact);
}

int SideMemo::side_along(const Triangle& triangle, const Vector3& d, std::uint64_t& exact) {
    if (const std::optional<int> sign = sure_side(triangle, d, true)) return *sign;
    return kept_side(triangle, d, true, exact);
}

}  // namespace nuvo
