#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "fast/rays/wide_bvh.h"
#include "fast/scene/fast_scene.h"
#include "nuvo/math/error_bounds.h"

// A ray under way. One ray alone waits for its own memory, comparisons and mispredicted branches
// most of the time; so a thread keeps many under way (rays are interleaved) and gives each a step
// in turn, sorted into those at a node and those at a leaf, so that hardly a branch depends on a
// ray.

namespace nuvo {

/// A primitive that a ray may meet, at a parameter (LocalRay) in [low, high].
struct RayCandidate {
    float low;
    float high;
    Slot slot;
    bool sure;  ///< the ray meets it, in front of the origin
};

/// Where the faces that a ray meets first and last are, in WideNode::face, by axis.
struct FacesOnRay {
    std::uint32_t near[3];
    std::uint32_t far[3];
};
constexpr std::array<FacesOnRay, 8> faces_by_signs() {
    std::array<FacesOnRay, 8> faces{};
    for (std::uint32_t signs = 0; signs < 8; ++signs)
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t negative = signs >> axis & 1;
            faces[signs].near[axis] =
                static_cast<std::uint32_t>((axis + 3 * negative) * kWideLanes);
            faces[signs].far[axis] =
                static_cast<std::uint32_t>((axis + 3 * (1 - negative)) * kWideLanes);
        }
    return faces;
}
inline constexpr std::array<FacesOnRay, 8> kFacesBySigns = faces_by_signs();

/// What LocalRay is, and its slabs, of 16 rays, each with four numbers side by side.
struct RayLanes {
    static constexpr std::size_t kRays = 16;

    alignas(64) float inverse[kRays][4];  ///< the fourth: behind()
    float near_add[kRays][4];             ///< the fourth: square()
    float far_add[kRays][4];              ///< the fourth: error()
    float direction[kRays][4];            ///< the fourth: least_unit()
    double origin[kRays][4];              ///< the fourth: 0
    double step[kRays][4];                ///< the fourth: 0
    double advance[kRays];
    double scale[kRays];
    std::int32_t signs[kRays];

    float behind(std::size_t ray) const { return inverse[ray][3]; }
    float square(std::size_t ray) const { return near_add[ray][3]; }  ///< |d|^2
    float error(std::size_t ray) const { return far_add[ray][3]; }
    /// Leaves on a finer grid are not tested in floats.
    float least_unit(std::size_t ray) const { return direction[ray][3]; }
};

struct RayState {
    static constexpr std::size_t kMaxCandidates = 32;
    static constexpr std::uint32_t kFinished = 1U << 30;

    /// What waits of a node, from near to far.
    struct alignas(64) Level {
        float entry[kWideLanes];  ///< where the ray enters the boxes, never negative
        std::uint32_t child[kWideLanes];
        std::uint32_t waiting;  ///< one bit each
    };

    /// What is known of a block of primitives of a leaf and not yet among the candidates.
    struct Block {
        std::uint32_t kept = 0;  ///< those that the ray may meet, one bit each
        std::uint32_t sure;      ///< of these
        const Slot* slots;
        float low[kMostLeafLanes];
        float high[kMostLeafLanes];
    };

    std::uint32_t next = 0;  ///< what comes next (WideNode::child), or kFinished
    float next_entry = 0;    ///< where the ray enters it
    float best = 0;          ///< the nearest sure hit's upper bound
    std::uint32_t candidate_count = 0;
    Level* top = nullptr;     ///< the first free level; something waits in each below it
    std::uint32_t signs = 0;  ///< of the direction: which of WideNode::order
    std::size_t index = 0;    ///< among the batch's rays
    const RayLanes* rays = nullptr;
    std::size_t lane = 0;  ///< among these
    Block block;
    /// The first one holds only kFinished.
    Level levels[WideBvh::kMostLevels + 2];
    RayCandidate candidates[kMaxCandidates];

    /// Sets out for the root.
    void start(std::size_t ray_index, const RayLanes& ray_lanes) {
        index = ray_index;
        rays = &ray_lanes;
        lane = ray_index % RayLanes::kRays;
        signs = static_cast<std::uint32_t>(ray_lanes.signs[lane]);
        best = kFloatInfinity;
        candidate_count = 0;
        levels[0].entry[0] = 0;
        levels[0].child[0] = kFinished;
        levels[0].waiting = 1;
        top = levels + 1;
        next = 0;
        next_entry = 0;
    }

    /// Takes the nearest of what waits highest into `next`; no branch depends on the ray.
    void take_next() {
        Level* const level = top - 1;
        const auto number = static_cast<std::uint32_t>(std::countr_zero(level->waiting));
        level->waiting &= level->waiting - 1;
        top -= static_cast<std::ptrdiff_t>(level->waiting == 0);
        next_entry = level->entry[number];
        next = level->child[number];
    }

    void drop_behind_best() {
        std::uint32_t kept = 0;
        for (std::uint32_t i = 0; i < candidate_count; ++i) {
            const RayCandidate candidate = candidates[i];
            if (candidate.low <= best) candidates[kept++] = candidate;
        }
        candidate_count = kept;
    }
};

}  // namespace nuvo
