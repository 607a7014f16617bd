#include "scenes.h"

#include <array>

namespace nuvo::generator {

namespace {

constexpr Takes kCamera{.camera = true};
constexpr Takes kCameraAndCopies{.camera = true, .copies = true};
constexpr Takes kCameraAndCount{.camera = true, .count = true};

constexpr std::array kScenes{
    Scene{"trianglemesh", "the default file: three triangle meshes on a plate", trianglemesh_scene},
    Scene{"appendixE", "thesis appendix E, figure 24: sphere, directional light", appendix_e},
    Scene{"figure25", "thesis figure 25: the sphere under a default spot light", figure_25},
    Scene{"appendixF", "thesis appendix F, figure 26: a narrow spot light", appendix_f},
    Scene{"figure27", "thesis figure 27: four spheres, red light, field of view 0.7", figure_27},
    Scene{"figure28", "thesis figure 28: four spheres, green light, field of view 0.8", figure_28},
    Scene{"figure29", "thesis figure 29: four spheres, blue light, field of view 0.9", figure_29},
    Scene{"appendixG", "thesis appendix G, figure 30: four spheres, grey light", appendix_g},
    Scene{"icosphere", "thesis figure 31: four icospheres, two shininesses", icosphere_scene},
    Scene{"teapot", "thesis base test: the Utah teapot, one mesh", teapot_scene, kCamera},
    Scene{"test1", "thesis test 1: 728 octahedra on a grid", test_1, kCamera},
    Scene{"test2", "thesis test 2: 1,000 octahedra at random", test_2, kCameraAndCopies},
    Scene{"test3", "thesis test 3: 5,985 spheres on five shells", test_3, kCamera},
    Scene{"test4", "thesis test 4: 3,200 octahedra in 64 clumps", test_4, kCamera},
    Scene{"octahedra", "any number (--count=N) of octahedra like test 2's, one mesh",
          many_octahedra, kCameraAndCount},
    Scene{"spheres", "any number (--count=N) of spheres at random", many_spheres, kCameraAndCount},
};

}  // namespace

std::span<const Scene> all_scenes() { return kScenes; }

}  // namespace nuvo::generator
