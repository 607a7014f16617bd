#include "memo_hash.h"
#include "plane_root.h"
#include "predicates_exact.h"

namespace nuvo {
namespace {

constexpr std::size_t kEntries = 4096;  // 400 kB; a power of two

// The side is the sign of n.d = (e1 x e2).d for d = a - p, or -p where p is a direction.
template <typename T>
struct SideVectors {
    Vec3<T> e1, e2, d;

    SideVectors(const Triangle& t, const Vector3& p, bool far)
        : e1(Vec3<T>(t.b) - Vec3<T>(t.a)),
          e2(Vec3<T>(t.c) - Vec3<T>(t.a)),
          d(far ? -Vec3<T>(p) : Vec3<T>(t.a) - Vec3<T>(p)) {}
    detail::Bounded<T> product() const {
        return detail::triple_product(d, cross(e1, e2), cross_magnitude(e1, e2));
    }
    // Each product has a factor 0, as in a plane across an axis: no difference rounds to 0.
    bool vanish() const {
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3;
            const int j = (k + 2) % 3;
            if (d[k] != 0 && ((e1[i] != 0 && e2[j] != 0) || (e1[j] != 0 && e2[i] != 0)))
                return false;
        }
        return true;
    }
};

std::optional<int> sure_side(const Triangle& t, const Vector3& p, bool far) {
    const SideVectors<double> cheap(t, p, far);
    const detail::Bounded<double> product = cheap.product();
    if (product.sure()) return product.sign();
    if (cheap.vanish()) return 0;
    const detail::Bounded<long double> wider = SideVectors<long double>(t, p, far).product();
    if (wider.sure()) return wider.sign();
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
