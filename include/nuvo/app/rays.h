#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/app/options.h"
#include "nuvo/math/ray.h"
#include "nuvo/render/render.h"

namespace nuvo::app {

/// A file of rays that cannot be read: what() is one line, "FILE: line N: reason".
class RaysError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Rays as text or as an array of NumPy. Text: a ray a line, "ox oy oz dx dy dz" in decimal,
/// separated by blanks, a comma or both; blank lines and what follows a # are skipped. Array: n x
/// 6, float64, float32 or integers. The direction is used as given, any length but zero. Throws
/// RaysError; `name` stands for the file.
std::vector<Ray> parse_rays(std::string_view text, const std::string& name);
/// "-": standard input.
std::vector<Ray> read_rays(const std::filesystem::path& path);

/// Where a ray hit: origin + t direction, rounded, and the unit normal of the shape there, on the
/// triangle's front or outside the sphere. Both are NaN for a miss.
struct HitPlace {
    Point3 point;
    Vector3 normal;
};
std::vector<HitPlace> hit_places(const Scene& scene, std::span<const Ray> rays,
                                 std::span<const RayAnswer> answers);

/// A line a ray: "1 shape triangle t" with t to 17 digits, "0 -1 -1 inf" for a miss; behind it the
/// point, the normal and the shape's name, where they are wanted. `places`: as many as answers, or
/// none; `names`: one a Shape, or none. Blanks in a name become _, and no name is -.
std::string answers_text(std::span<const RayAnswer> answers, std::span<const HitPlace> places = {},
                         std::span<const std::string> names = {}, const AnswerParts& parts = {});
/// So many bytes of a name at most are told in an array.
inline constexpr std::size_t kMaxNameBytes = 256;
/// The same as an array of records for NumPy: hit (bool), shape and triangle (int64), t (float64),
/// point and normal (3 float64) and def (bytes) where they are wanted; no name is empty.
std::string answers_npy(std::span<const RayAnswer> answers, std::span<const HitPlace> places = {},
                        std::span<const std::string> names = {}, const AnswerParts& parts = {});

}  // namespace nuvo::app
