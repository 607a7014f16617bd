#pragma once

#include <cstdint>
#include <vector>

#include "fast/scene/fast_scene.h"
#include "fast/shadow/shadow_geometry.h"
#include "nuvo/math/big_vector.h"

// What may stand between a light and a point is looked up in a grid of the shadow rays of the light
// (Haines and Greenberg 1986, "The light buffer: a shadow-testing accelerator"): each cell lists
// the items that some shadow ray through it may meet. Lists leave out nothing, so the answer is the
// octree's; they are short where items are about as large as cells.
//
// A light far outside of the scene sees it through one plane, x_k = 0 for the axis k along which it
// stands farthest: the shadow ray through P meets that plane at u = P_u - P_k W_u / W_k, W being
// the vector from P to the light. A light among the items looks through the six faces of a cube
// around it, at u = W_u / W_k.

namespace nuvo {

/// Places on a light's plane or face count from 0 to kLightSteps - 1 on both axes.
inline constexpr int kLightSteps = 1 << 16;

/// An item of a cell's list.
struct LightEntry {
    Slot slot;
    float near;            ///< no part of it lies less deep
    std::uint16_t low[2];  ///< steps between which it lies
    std::uint16_t high[2];
};
static_assert(sizeof(LightEntry) == 16);

/// Cells of one size: columns x rows of them on each face.
struct LightGrid {
    int columns = 1;
    int rows = 1;
    std::uint32_t first_cell = 0;
};

/// The light buffer of one light. Items are listed on the finest grid on which they cover few
/// cells.
struct LightBuffer {
    /// What it is made from.
    struct Source {
        const FastScene& scene;
        const BigVector<Quadric>& quadrics;
        double reach;  ///< bounds |coordinate| in the scene
        double touch;  ///< what lies within this of a shadow ray may block it
        /// Which triangles may hide something, 8 in a byte; null: all.
        const std::uint8_t* hides = nullptr;
    };
    static constexpr std::size_t kMaxGrids = 4;

    LightBuffer() = default;
    LightBuffer(const LightPoint& light, const Source& source, InstructionSet isa);

    /// False where nothing may be looked up: the light is too far, or lists would be too long.
    bool usable() const { return !grids.empty(); }
    std::size_t memory_bytes() const {
        return starts.size() * sizeof(std::uint32_t) + entries.size() * sizeof(LightEntry);
    }

    bool inside = false;           ///< six faces; else one
    int axis = 0;                  ///< k of the one face
    float sign = 1;                ///< of W_k
    float low[2] = {};             ///< u and v of step 0
    float steps[2] = {};           ///< per unit of u and v
    float point_error = 0;         ///< points known this well are looked up in one cell of a grid
    float stretch = 0;             ///< of u and v for an error of 1; inside: of W_k = 1
    float nearest = 0;             ///< inside: points with a lesser W_k are not looked up
    std::vector<LightGrid> grids;  ///< from fine to coarse
    BigVector<std::uint32_t> starts;  ///< of the cells' lists, and the end
    BigVector<LightEntry> entries;    ///< and room for a few more to be read
};

}  // namespace nuvo
