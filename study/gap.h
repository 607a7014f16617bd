#pragma once

#include <vector>

#include "trees.h"

/// How far each method's point is from the exact optimum, on the same voxels for all.
namespace nuvo::study {

/// A voxel as a strategy is asked about it.
struct AskedVoxel {
    Voxel voxel;
    std::vector<Bounds3> boxes;
    double margin = 0;
};

/// The voxels with at least two items that the spatial method is asked about; of more than `most`
/// every so many.
std::vector<AskedVoxel> asked_voxels(const Scene& scene, const Primitives& primitives,
                                     const TreeOptions& options, std::size_t most);

/// One method against one objective: what its value exceeds the optimum by, as a share of it.
struct Gap {
    std::size_t voxels = 0;     ///< on which both have an answer
    std::size_t without = 0;    ///< on which the method has none
    std::size_t exact = 0;      ///< voxels where the method's value is the optimum's
    std::size_t unbounded = 0;  ///< where the optimum is zero and the method's value is not
    double mean = 0;            ///< of the others
    double worst = 0;
    double evaluations = 0;  ///< a voxel
};
/// By eq. 19 (kShare) or true areas, against the least value of that space.
Gap gap_of(const Method& method, std::span<const AskedVoxel> voxels, Weight weight, Space space);

}  // namespace nuvo::study
