#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/scene/fast_scene.h"
#include "nuvo/math/big_vector.h"

// The hierarchy of boxes for single rays. A ray of its own has no neighbours to share a step with,
// so a step is made to decide more: a node has up to 16 children (Dammertz, Hanika and Keller 2008,
// "Shallow bounding volume hierarchies"), and a leaf holds about as many primitives as are tested
// at once.

namespace nuvo {

inline constexpr std::size_t kWideLanes = 16;  ///< of a node
/// A leaf's primitives are tested by so many at once, or twice as many where it holds more.
inline constexpr std::size_t kLeafLanes = 8;
inline constexpr std::size_t kMostLeafLanes = 2 * kLeafLanes;
inline constexpr std::uint32_t kMostOfLeaf = 4 * kLeafLanes;  ///< primitives

/// Children side by side; behind the last one boxes that no ray meets (low +inf, high -inf).
struct alignas(64) WideNode {
    float face[6 * kWideLanes];       ///< low x of all, low y, low z, high x, high y, high z
    std::uint32_t child[kWideLanes];  ///< index of a node; with WideBvh::kLeaf: place of a leaf
    /// The lanes from near to far for rays whose direction's sign bits are 1 x + 2 y + 4 z: number
    /// i stands in bits 4 (i / 2) to 4 (i / 2) + 3 of word i % 2. Boxes may overlap: the order is
    /// for speed.
    std::uint32_t order[8][2];
};

/// Copies of primitives of a leaf, side by side, in 32-bit words from its place on: this head, then
/// the slots of triangles, spheres and others, with kFrontOnly where the back is invisible; center
/// x, y, z and radius of the spheres in the local frame; corners of the triangles (a.x of all, a.y
/// of all ... c.z of all) in 16 bits each, local coordinate = base + unit * number on each axis.
/// The others are to be tested exactly.
struct WideLeafHead {
    float base[4];            ///< the fourth: finest_unit()
    std::int8_t exponent[4];  ///< unit = 2^exponent; the fourth: 0
    std::uint8_t triangles;
    std::uint8_t spheres;
    std::uint8_t others;

    float& finest_unit() { return base[3]; }
    float finest_unit() const { return base[3]; }
};
inline constexpr std::uint32_t kFrontOnly = 1U << 31;
inline constexpr std::size_t kLeafHeadWords = sizeof(WideLeafHead) / sizeof(std::uint32_t);
static_assert(kLeafHeadWords == 6);

/// How far a copied corner lies from base + unit * number, in units: rounded to nearest, plus what
/// three double roundings of local coordinates can add while the unit is at least 2^-38.
inline constexpr double kCornerRounding = 0.5 + 0x1p-10;
/// Smaller leaves are copied as coarsely as 2 to this.
inline constexpr int kLeastExponent = -38;
/// And the unit of an axis is no finer than 2 to this unless that of the widest is: from units half
/// as wide on, rays from far within the scene could not be tested (RayLanes: least_unit).
inline constexpr int kFlattestExponent = -32;
/// Largest number of a corner.
inline constexpr double kLargestCorner = 65535;

/// Appends a leaf with these slots, at most kMostOfLeaf, which ascend, and returns its place. The
/// grid spans the box, too: there the rays come in.
std::uint32_t append_leaf(const FastScene& scene, std::span<const Slot> slots,
                          const Bounds3T<float>& box, BigVector<std::uint32_t>& words);

struct WideBvh {
    static constexpr std::uint32_t kLeaf = 1U << 31;
    /// Of nodes, on the way from the root to any leaf.
    static constexpr int kMostLevels = 80;

    explicit WideBvh(const FastScene& scene);

    std::size_t memory_bytes() const {
        return nodes.size() * sizeof(WideNode) + leaves.size() * sizeof(std::uint32_t);
    }

    BigVector<WideNode> nodes;        ///< 0 is the root
    BigVector<std::uint32_t> leaves;  ///< with room behind the last for a load of any lanes
    float reach = 0;                  ///< the largest |coordinate| of a box
};

}  // namespace nuvo
