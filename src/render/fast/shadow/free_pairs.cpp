#include "fast/shadow/free_pairs.h"

#include <cmath>

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/exact.h"

namespace nuvo {
namespace {

// The sign of n.v for the normal n = (b - a) x (c - a) of a triangle, exactly, where v is a
// direction or leads from a corner.
class PlaneSide {
  public:
    explicit PlaneSide(const Triangle& t) : a_(t.a), b_(t.b), c_(t.c) {
        const Vector3 e1 = t.b - t.a;
        const Vector3 e2 = t.c - t.a;
        normal_ = cross(e1, e2);
        size_ = max_norm(e1) * max_norm(e2);
    }

    // From the nearest corner, so that coincident triangles keep their digits; a corner is in the
    // plane.
    int of_point(const Point3& p) const {
        Vector3 way = p - a_;
        for (const Point3& corner : {b_, c_})
            if (max_norm(p - corner) < max_norm(way)) way = p - corner;
        if (way == Vector3{}) return 0;
        const int sign = rounded(way);
        return sign != 0 ? sign : exact(ExactVector(p) - ExactVector(a_));
    }
    int of_direction(const Vector3& d) const {
        const int sign = rounded(d);
        return sign != 0 ? sign : exact(ExactVector(d));
    }

  private:
    // 0: not sure. Six terms of at most size_ |way|, each of 8 roundings as of an edge function.
    // [numerics: edge bound]
    int rounded(const Vector3& way) const {
        constexpr double kSmallest = 0x1p-900;  // nothing has lost to underflow
        const double value = dot(normal_, way);
        const double bound = 6 * gamma(9) * size_ * max_norm(way);
        if (!(size_ > kSmallest && bound > kSmallest && std::fabs(value) > bound)) return 0;
        return value > 0 ? 1 : -1;
    }
    int exact(const ExactVector& way) const {
        const ExactVector a(a_);
        return dot(cross(ExactVector(b_) - a, ExactVector(c_) - a), way).sign();
    }

    Point3 a_, b_, c_;
    Vector3 normal_;
    double size_ = 0;
};

Triangle triangle_of(const FastScene& scene, Slot slot) {
    const PrimitiveSource& source = scene.source(slot);
    return std::get<TriangleMesh>(scene.scene().objects[source.object].shape)
        .triangle(source.triangle);
}

}  // namespace

bool FreePairs::is_free(Slot lit, Slot occluder, std::size_t light) const {
    const Light& exact = scene_.scene().lights[light];
    const Triangle t = triangle_of(scene_, lit);
    const PlaneSide plane(triangle_of(scene_, occluder));
    const int side = exact.kind == Light::Kind::kDirectional ? plane.of_direction(-exact.direction)
                                                             : plane.of_point(exact.location);
    if (side == 0) return true;
    return plane.of_point(t.a) * side >= 0 && plane.of_point(t.b) * side >= 0 &&
           plane.of_point(t.c) * side >= 0;
}

}  // namespace nuvo
