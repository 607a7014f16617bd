#include "scenes.h"

#include <array>

namespace nuvo::generator {

namespace {

constexpr Takes kCamera{.camera = true};
constexpr Takes kCount{.count = true};
constexpr Takes kCameraAndCount{.camera = true, .count = true};

constexpr std::array kScenes{
    Scene{"trianglemesh", "thesis test 1, the default file: 728 octahedra on a grid",
          trianglemesh_scene, kCamera},
    Scene{"both", "thesis test 2: 1,000 octahedra at random", both_scene, kCamera},
    Scene{"concentric", "thesis test 3: 5,985 spheres on five shells", concentric_scene, kCamera},
    Scene{"clumped", "thesis test 4: 3,200 octahedra in 64 clumps", clumped_scene, kCamera},
    Scene{"teapot", "thesis base test: the Utah teapot, one mesh", teapot_scene, kCamera},
    Scene{"figure19", "thesis figure 19: an octahedron with face normals", figure_19},
    Scene{"figure20", "thesis figure 20: an octahedron with vertex normals", figure_20},
    Scene{"figure22", "thesis figure 22: four spheres, to be seen with and without a bias",
          figure_22},
    Scene{"appendixE", "thesis appendix E, figure 24: sphere, directional light", appendix_e},
    Scene{"figure25", "thesis figure 25: the sphere under a default spot light", figure_25},
    Scene{"appendixF", "thesis appendix F, figure 26: a narrow spot light", appendix_f},
    Scene{"figure27", "thesis figure 27: four spheres, red light, field of view 0.7", figure_27},
    Scene{"figure28", "thesis figure 28: four spheres, green light, field of view 0.8", figure_28},
    Scene{"figure29", "thesis figure 29: four spheres, blue light, field of view 0.9", figure_29},
    Scene{"appendixG", "thesis appendix G, figure 30: four spheres, grey light", appendix_g},
    Scene{"icosphere", "thesis figure 31: four icospheres, two shininesses", icosphere_scene},
    Scene{"showcase", "three triangle meshes on a plate", showcase_scene},
    Scene{"octahedra", "any number (--count=N) of octahedra like test 2's, one mesh",
          many_octahedra, kCameraAndCount},
    Scene{"spheres", "any number (--count=N) of spheres at random", many_spheres, kCameraAndCount},
    Scene{"terrain", "a landscape of about --count=N triangles", terrain_scene, kCount},
    Scene{"city", "--count=N houses, from above or (--camera=near) from the street", city_scene,
          kCameraAndCount},
    Scene{"interior", "--count=N rooms of 14,000 triangles, from within", interior_scene, kCount},
    Scene{"assembly", "--count=N cars of 28,500 triangles", assembly_scene, kCount},
    Scene{"floor", "a ball on a floor --count=N times as wide", floor_scene, kCount},
    Scene{"molecule", "a chain of --count=N spheres", molecule_scene, kCount},
    Scene{"aisles", "study: --count=N octahedra in blocks between aisles", aisles_scene, kCount},
    Scene{"drift", "study: --count=N octahedra, thickest in one corner", drift_scene, kCount},
    Scene{"stadium", "study: --count=N octahedra, half of them in a small cluster", stadium_scene,
          kCount},
    Scene{"sticks", "study: --count=N long thin octahedra", sticks_scene, kCount},
    Scene{"sizes", "study: --count=N octahedra of sizes over a wide range", sizes_scene, kCount},
};

}  // namespace

std::span<const Scene> all_scenes() { return kScenes; }

}  // namespace nuvo::generator
