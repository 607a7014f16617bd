#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
#include <optional>

#include "nuvo/image/image.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/scene.h"
#include "sieve.h"

/// Pictures by the definitions of docs/numerics.md: visibility and shadows by brute force in 60
/// digits, light by ISO/IEC 19775-1 17.2.2.4 in 64-bit floats. Shares the scene's types with the
/// program and nothing else.
namespace nuvo::hard {

using Digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                             boost::multiprecision::et_off>;
using DigitsVector = Vec3<Digits>;

class Reference {
  public:
    /// `scene` outlives the reference.
    Reference(const Scene& scene, Resolution resolution);

    struct Sample {
        bool hit = false;
        std::size_t object = 0;
        std::size_t triangle = 0;
        std::uint64_t lit = 0;  ///< bit i: light i reaches the point unblocked
        Rgb8 color{};

        bool sees_the_same(const Sample& other) const {
            return hit == other.hit && object == other.object && triangle == other.triangle &&
                   lit == other.lit;
        }
    };
    /// At a point of the picture, in pixels from its top left corner.
    Sample sample(double x, double y) const { return sample(x, y, {}); }
    Sample pixel(int x, int y) const { return sample(x + 0.5, y + 0.5); }
    /// False on the silhouette mask: a move by 1e-3 pixel in one of 8 directions changes the
    /// nearest primitive or the lights that reach it.
    bool stable(int x, int y) const;
    /// False where a lit point that is off by a few roundings of the scene's coordinates in one of
    /// 8 directions has other lights: there definition 4 depends on how the point is rounded, as
    /// where the way to the light runs exactly along a surface.
    bool stable_when_rounded(int x, int y) const;

  private:
    struct Line {
        DigitsVector origin;
        DigitsVector direction;
    };
    struct Meeting {
        std::size_t object = 0;
        std::size_t triangle = 0;
        Digits t;
        DigitsVector point;
        Vec3<long double> geometric;  ///< unit normal
        Vec3<long double> shading;
        std::optional<Vec3<long double>> color;  ///< of a mesh with colors
    };
    struct Roots {
        Digits first;
        Digits second;
    };

    /// With the lit point moved by `error`, in units of the largest coordinate of the scene.
    Sample sample(double x, double y, const Vector3& error) const;
    bool lit_along_the_surface(int x, int y) const;
    Line line(double x, double y) const;
    std::optional<Meeting> nearest(const Line& line) const;
    /// The plane's t, and weights of the corners b and c.
    static std::optional<DigitsVector> plane(const Line& line, const Triangle& triangle);
    static std::optional<Roots> roots(const Line& line, const Shape& shape);
    void finish(const Line& line, Meeting& meeting) const;
    bool blocked(const Meeting& meeting, const Line& shadow, bool endless) const;
    Vec3<long double> background(const Vec3<long double>& direction) const;
    /// The material's color, or the mesh's in its place: the diffuse one, or the emissive one
    /// where the material is not lit.
    Vec3<long double> emitted(const Meeting& meeting) const;
    std::optional<Vec3<long double>> light(const Light& light, const Meeting& meeting,
                                           const Vec3<long double>& to_viewer) const;

    const Scene& scene_;
    Resolution resolution_;
    Digits half_width_;
    Digits half_height_;
    Sieve sieve_;
    double largest_ = 0;  ///< coordinate
};

}  // namespace nuvo::hard
