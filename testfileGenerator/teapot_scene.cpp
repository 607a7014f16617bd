// The Utah teapot of the thesis' base test: Newell's 32 bicubic Bezier patches as one mesh.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "camera.h"
#include "mesh.h"
#include "scenes.h"
#include "x3d_text.h"

namespace nuvo::generator {

namespace {

// data/newell-teapot-patches.txt, put in when the build is configured: the program needs no file.
constexpr std::string_view kPatchText =
#include "newell_teapot_patches.inc"
    ;

// The thesis' teapot has 25,352 triangles. 20 x 20 squares a patch come nearest: 25,600 triangles,
// of which 160 at the lid's and the bottom's middle, where a patch's edge is a single point, have
// no area and are left out.
constexpr int kSteps = 20;

// The thesis shows it from above (figure 32). Height of the camera over the lid: from there 695 x
// 410 = 284,950 rays of 1920 x 1080 enter the published program's box of the mesh, which reaches as
// far to either side of the mean of the corners as the furthest of them. 284,970 rays follow from
// the thesis' counts.
constexpr double kCameraHeight = 11.224;

// All control points have at most five decimals, so that this makes them whole numbers.
constexpr double kUnitsPerLength = 100000;

/// A point of a patch times kUnitsPerLength * kSteps^6, in whole numbers: below 4 * 10^5 * 6.4 *
/// 10^7 in size. Points that two patches share come out equal, whichever way round each runs.
using ExactPoint = std::array<std::int64_t, 3>;

using Patch = std::array<ExactPoint, 16>;  // control points, in units

std::vector<Patch> read_patches() {
    std::vector<std::int64_t> units;
    const char* at = kPatchText.data() + kPatchText.find('\n');  // after the heading
    const char* const end = kPatchText.data() + kPatchText.size();
    while (at != end) {
        double value = 0;
        const auto [rest, error] = std::from_chars(at, end, value);
        if (error == std::errc()) units.push_back(std::llround(value * kUnitsPerLength));
        at = error == std::errc() ? rest : at + 1;  // a blank or the end of a line
    }
    std::vector<Patch> patches(units.size() / 48);
    for (std::size_t i = 0; i < patches.size() * 48; ++i) {
        patches[i / 48][i % 48 / 3][i % 3] = units[i];
    }
    return patches;
}

/// The four cubic Bernstein polynomials at i / kSteps, times kSteps^3.
std::array<std::int64_t, 4> bernstein(std::int64_t i) {
    const std::int64_t j = kSteps - i;
    return {j * j * j, 3 * i * j * j, 3 * i * i * j, i * i * i};
}

ExactPoint evaluate(const Patch& patch, int row, int column) {
    const auto by_row = bernstein(row);
    const auto by_column = bernstein(column);
    ExactPoint sum{};
    for (std::size_t k = 0; k < patch.size(); ++k) {
        const std::int64_t weight = by_row[k / 4] * by_column[k % 4];
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += weight * patch[k][axis];
    }
    return sum;
}

/// The point in lengths, turned about the x axis so that Newell's z, which is up, becomes y.
Point upright(const ExactPoint& p) {
    constexpr double kCube = kSteps * kSteps * kSteps;
    constexpr double kScale = kUnitsPerLength * kCube * kCube;
    const auto length = [](std::int64_t v) {
        return six_decimals(static_cast<double>(v) / kScale);
    };
    return {length(p[0]), length(p[2]), -length(p[1])};
}

/// All patches as one mesh in which equal points are one corner, so that normals are smooth across
/// the patches too.
Mesh teapot() {
    Mesh mesh;
    std::map<ExactPoint, int> corners;
    const auto corner = [&](const ExactPoint& p) {
        const auto [found, is_new] = corners.try_emplace(p, static_cast<int>(mesh.points.size()));
        if (is_new) mesh.points.push_back(upright(p));
        return found->second;
    };
    const auto add = [&](int a, int b, int c) {
        if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    };
    for (const Patch& patch : read_patches()) {
        std::array<std::array<int, kSteps + 1>, kSteps + 1> at{};
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; j <= kSteps; ++j) {
                at[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                    corner(evaluate(patch, i, j));
            }
        }
        for (std::size_t i = 0; i < kSteps; ++i) {
            for (std::size_t j = 0; j < kSteps; ++j) {
                // Newell's rows turn the other way round than the standard's outside wants.
                add(at[i][j], at[i + 1][j + 1], at[i + 1][j]);
                add(at[i][j], at[i][j + 1], at[i + 1][j + 1]);
            }
        }
    }
    return mesh;
}

}  // namespace

std::string teapot_scene(const Variation& variation) {
    const Mesh mesh = teapot();
    Point low = mesh.points.front();
    Point high = low;
    for (const Point& p : mesh.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Point middle{six_decimals((low.x + high.x) / 2), six_decimals((low.y + high.y) / 2),
                       six_decimals((low.z + high.z) / 2)};
    const bool from_above = variation.camera == CameraPlace::kOwn;
    const double fitting = fitting_distance((high.y - low.y) / 2);
    const double distance = six_decimals(camera_fraction(variation.camera, 0) * fitting);
    std::string out = scene_head(
        "teapot", "The Utah teapot (Newell): 32 patches at 20 x 20, 25,440 triangles in one mesh");
    out += from_above
               ? "    <Viewpoint position='" +
                     triple({middle.x, high.y + kCameraHeight, middle.z}) +
                     "' orientation='1 0 0 -1.5707963267948966' fieldOfView='0.9'/>\n"
               : "    <Viewpoint position='" + triple({middle.x, middle.y, high.z + distance}) +
                     "' fieldOfView='0.7853981633974483'/>\n";
    out += sky_and_no_headlight();
    // In the middle of the shapes like in the other tests; here that is inside the pot.
    out += "    <PointLight location='" + triple(middle) + "'/>\n";
    out += std::string("    <DirectionalLight direction='") + (from_above ? "0 -1 0" : "0 0 -1") +
           "'/>\n";
    out += "    <Shape>\n" + appearance("diffuseColor='0.75 0.62 0.5'", "", "      ");
    out += triangle_set(mesh, "", Shading::kSmooth, "      ") + "    </Shape>\n";
    return out + scene_foot();
}

}  // namespace nuvo::generator
