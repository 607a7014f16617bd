#pragma once

#include <cmath>

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {

/// A prism around things that lie in each other: the planes of one triangle among them and through
/// its edges, moved out until all lie behind. Empty: no bound.
class HullPlanes {
  public:
    HullPlanes() = default;
    explicit HullPlanes(const Triangle& model) {
        const Vector3 normal = cross(model.b - model.a, model.c - model.a);
        const Vector3 outwards[kPlanes] = {normal, -normal, cross(model.b - model.a, normal),
                                           cross(model.c - model.b, normal),
                                           cross(model.a - model.c, normal)};
        for (const Vector3& way : outwards) planes_[count_++].out = normalized(way);
    }

    /// Moves the planes out to hold p.
    void hold(const Point3& p) {
        for (int i = 0; i < count_; ++i) {
            const double height = dot(planes_[i].out, p) + error(planes_[i].out, p);
            if (!(height <= planes_[i].height)) planes_[i].height = height;
        }
    }

    /// The ray surely passes by at all t > 0.
    bool surely_missed(const ExactRay& ray) const {
        constexpr double kDown = 1 - gamma(4);
        double first = 0;
        double last = kInfinity;
        for (int i = 0; i < count_; ++i) {
            // All of it that lies behind the plane: t speed <= room.
            const Vector3& out = planes_[i].out;
            const double room = (planes_[i].height - dot(out, ray.origin())) +
                                error(out, ray.origin()) + gamma(2) * std::fabs(planes_[i].height);
            const double speed = dot(out, ray.direction());
            const double unsure = error(out, ray.direction());
            if (speed > unsure) {
                if (room < 0) return true;
                const double t = room / ((speed - unsure) * kDown);
                if (t < last) last = t;
            } else if (room < 0) {
                if (-speed + unsure <= 0) return true;
                const double t = -room * kDown / (-speed + unsure);
                if (t > first) first = t;
            }
        }
        return first * kDown > last;
    }

  private:
    static constexpr int kPlanes = 5;
    /// Bounds the error of dot(out, p), where p may be off by a roundoff.
    static double error(const Vector3& out, const Vector3& p) {
        return gamma(8) *
                   (std::fabs(out.x * p.x) + std::fabs(out.y * p.y) + std::fabs(out.z * p.z)) +
               16 * kUnderflow;
    }

    struct Plane {
        Vector3 out;
        double height = -kInfinity;
    };
    Plane planes_[kPlanes];
    int count_ = 0;
};

}  // namespace nuvo
