#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "nuvo/app/options.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/profile.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::app {

/// The word that stands for a value on the command line and in reports: one table for both ways.
template <typename E>
struct Choice {
    std::string_view name;
    E value;
};
template <typename E>
Choice(const char*, E) -> Choice<E>;  // clang 14 does not deduce it for an aggregate

inline constexpr std::array kProfiles{Choice{"exact", &exact_profile},
                                      Choice{"thesis", &thesis_profile},
                                      Choice{"fast", &fast_profile}};
inline constexpr std::array kOctreeTypes{Choice{"uniform", OctreeType::kUniform},
                                         Choice{"nonuniform", OctreeType::kNonuniform}};
inline constexpr std::array kMidpoints{Choice{"spatial", MidpointChoice::kSpatial},
                                       Choice{"sweep", MidpointChoice::kSweep},
                                       Choice{"published", MidpointChoice::kPublished},
                                       Choice{"mlsl-sbplx", MidpointChoice::kPublished}};
inline constexpr std::array kCosts{Choice{"thesis", CostChoice::kThesis},
                                   Choice{"calibrated", CostChoice::kCalibrated}};
inline constexpr std::array kLeafContents{Choice{"shapes", LeafContent::kShapes},
                                          Choice{"primitives", LeafContent::kPrimitives}};
inline constexpr std::array kWalks{Choice{"hash", WalkChoice::kHash},
                                   Choice{"descent", WalkChoice::kDescent}};
inline constexpr std::array kPrecisions{Choice{"float", Precision::kFloat},
                                        Choice{"double", Precision::kDouble},
                                        Choice{"exact", Precision::kExact}};
inline constexpr std::array kBackFaces{Choice{"solid", BackFaces::kSolid},
                                       Choice{"draw", BackFaces::kDraw}};
inline constexpr std::array kTracers{Choice{"serial", TracerChoice::kSerial},
                                     Choice{"tiles", TracerChoice::kTiles}};
inline constexpr std::array kInstructionSets{
    Choice{"avx512", InstructionSet::kAvx512}, Choice{"avx2", InstructionSet::kAvx2},
    Choice{"sse4", InstructionSet::kSse4}, Choice{"sse2", InstructionSet::kSse2}};
inline constexpr std::array kHeatmaps{Choice{"tests", HeatmapOf::kTests},
                                      Choice{"searches", HeatmapOf::kSearches},
                                      Choice{"stage", HeatmapOf::kStage}};
inline constexpr std::array kDefaults{Choice{"x3d", &x3d::standard_defaults},
                                      Choice{"thesis", &x3d::thesis_defaults}};
inline constexpr std::array kHeadlights{Choice{"auto", x3d::Headlight::kAuto},
                                        Choice{"on", x3d::Headlight::kOn},
                                        Choice{"off", x3d::Headlight::kOff}};

/// The names as the help shows them: "a|b|c".
template <typename E, std::size_t N>
std::string joined_names(const std::array<Choice<E>, N>& choices) {
    std::string names;
    for (const Choice<E>& choice : choices)
        names += (names.empty() ? "" : "|") + std::string(choice.name);
    return names;
}

/// The name of a value of the table; empty for a value that it lacks.
template <typename E, std::size_t N>
constexpr std::string_view name_of(const std::array<Choice<E>, N>& choices, E value) {
    for (const Choice<E>& choice : choices)
        if (choice.value == value) return choice.name;
    return {};
}

}  // namespace nuvo::app
