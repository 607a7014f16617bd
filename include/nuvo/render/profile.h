#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace nuvo {

enum class OctreeType { kUniform, kNonuniform };
/// How a non-uniform voxel is cut. Uniform trees always cut at the spatial midpoint.
enum class MidpointChoice { kSpatial, kSweep, kPublished };
enum class LeafContent { kShapes, kPrimitives };
enum class WalkChoice { kHash, kDescent };
enum class Precision { kFloat, kDouble, kExact };
/// kThesis: the published costs and the rules that go with them [5.4]; kCalibrated: constant,
/// measured costs.
enum class CostChoice { kThesis, kCalibrated };
/// What becomes of the back faces of solid shapes: invisible, to the camera as to lights (VRML97
/// 4.6.3.3), or drawn and lit like fronts, as published.
enum class BackFaces : std::uint8_t { kSolid, kDraw };
/// kSerial: one ray at a time through an Octree, all else as chosen. kTiles: FastTracer, which
/// shows what the exact profile shows and whose other answers but the type are its own.
enum class TracerChoice { kSerial, kTiles };

/// One answer to every question that decides what is built, walked and computed. A named profile is
/// nothing but a value of this type.
struct Profile {
    TracerChoice tracer = TracerChoice::kSerial;
    OctreeType type = OctreeType::kUniform;
    MidpointChoice midpoint = MidpointChoice::kSweep;  ///< used by non-uniform trees only
    CostChoice costs = CostChoice::kCalibrated;
    std::optional<std::size_t> max_objects;  ///< stop rule of COMP1011 instead of the costs
    LeafContent leaves = LeafContent::kPrimitives;
    WalkChoice walk = WalkChoice::kHash;
    /// Step past a voxel's face in units of the smallest voxel width; none: exact faces.
    std::optional<double> step;
    Precision precision = Precision::kExact;
    /// Shadow rays start this far along the normal, in scene units; none: exact shadows.
    std::optional<double> bias;
    BackFaces back_faces = BackFaces::kSolid;
};

/// The published program, its slips of arithmetic mended.
Profile thesis_profile();
/// The thesis' structure with right numbers: the default and the reference of every other tracer.
Profile exact_profile();
/// The exact profile's pictures in the least time: tiles, and the octree that was measured faster.
Profile fast_profile();

}  // namespace nuvo
