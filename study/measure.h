#pragma once

#include <string>
#include <vector>

#include "structures/structure.h"
#include "trees.h"

/// Methods and structures measured on one scene: the same rays, the same counters.
namespace nuvo::study {

struct MeasureOptions {
    TreeOptions tree;
    Resolution resolution{240, 135};
    Resolution brute_resolution{48, 27};   ///< pictures are compared with brute force's
    std::size_t random_rays = 20'000;      ///< from points of the scene's box to others
    int evaluations = Evaluations{}.most;  ///< of a search in one voxel
    int rounds = 3;                        ///< of builds and timed pictures, interleaved
};

struct Row {
    std::string name;
    std::string kind;  ///< "octree", "other"
    Sizes sizes;
    double sah = 0;  ///< eq. 10 at the structure's own prices; 0 where it has none
    Work camera;     ///< of one picture, shadow rays included
    Work random;
    double evaluations = 0;  ///< of one build
    std::vector<double> build_seconds;
    std::vector<double> trace_seconds;
    bool same_picture = false;   ///< as the spatial octree's, byte for byte
    bool same_as_brute = false;  ///< as brute force's in its resolution
};

/// The methods' octrees, then grid, kd-tree and BVH where `others` asks, and brute force's small
/// picture as the truth.
std::vector<Row> measure(const Scene& scene, std::span<const Method* const> methods, bool others,
                         const MeasureOptions& options);

}  // namespace nuvo::study
