#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nuvo/octree/octree.h"
#include "nuvo/render/planes.h"
#include "nuvo/render/shading.h"

namespace nuvo {

/// One primitive that a ray was tested against.
struct TestStory {
    PrimitiveId primitive = 0;
    bool hit = false;         ///< met; of a shadow ray: in the way
    std::optional<double> t;  ///< of the hit, where the test finds it
    Stage stage = Stage::kCheap;
};

/// One voxel that a ray went through.
struct VoxelStory {
    Label name = 0;  ///< Glassner's
    Bounds3 box;
    /// Where the ray is in the box, rounded: in units of its direction, from 0 on.
    double t_in = 0;
    double t_out = 0;
    std::uint32_t items = 0;  ///< listed there: each counts as one test
    /// Of its items' primitives, but for those that were tested in an earlier voxel.
    std::vector<TestStory> tests;
};

/// One ray through the octree, or past it.
struct RayStory {
    Ray ray;
    double t_end = 0;               ///< a light's place; infinity: endless
    std::uint64_t searches = 0;     ///< for a next voxel
    std::vector<TestStory> before;  ///< before the first voxel: of the lit primitive itself
    std::vector<VoxelStory> voxels;

    std::uint64_t intersection_tests() const {
        std::uint64_t sum = 0;
        for (const VoxelStory& voxel : voxels) sum += voxel.items;
        return sum;
    }
};

/// What becomes of one light at the point that a pixel shows.
struct LightStory {
    enum class End : std::uint8_t {
        kOutOfScope,  ///< it does not light this shape
        kTooFar,      ///< gives nothing at this point: beyond its radius or its cone
        kBlocked,
        kLit,
    };
    End end = End::kOutOfScope;
    std::optional<RayStory> shadow;  ///< none where the light casts no shadow, or gives nothing
    std::optional<LightSample> sample;
    LightTerms terms;  ///< before strength and the light's color
    Color adds;        ///< to the pixel's color
};

/// The surface that a pixel shows.
struct SurfaceStory {
    PrimitiveId primitive = 0;
    std::int64_t shape = 0;     ///< the Shape's place in the document
    std::int64_t triangle = 0;  ///< in the Shape's own list; 0 for a sphere
    double t = 0;
    std::optional<Point3> point;    ///< none where the material is unlit: nobody asks
    std::optional<Vector3> normal;  ///< the one that lights it
    Material material;
    std::vector<LightStory> lights;  ///< one a light of the scene; none where it is unlit
};

/// The life of a pixel's ray.
struct PixelStory {
    RayStory primary;
    std::optional<SurfaceStory> surface;  ///< none: the background
    Color color;                          ///< emissive color and what the lights add
    Rgb8 bytes;                           ///< in the picture
};

/// Follows the ray of pixel (x, y) as render() does it, with the same answers. Of a leaf whose
/// items lie in each other, and of what exact arithmetic has found before, a picture remembers more
/// than its first ray does: there the tests of single primitives and their stages may be fewer in
/// it.
PixelStory explain_pixel(const Scene& scene, const Primitives& primitives, const Octree& octree,
                         const Profile& profile, Resolution resolution, int x, int y);

}  // namespace nuvo
