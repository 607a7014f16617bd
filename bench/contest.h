#pragma once

#include <optional>
#include <string>
#include <vector>

#include "embree_frame.h"
#include "figures.h"
#include "nuvo/render/fast.h"

namespace nuvo::bench {

/// What is measured, and how.
struct ContestOptions {
    std::string scene;
    std::string json;
    Resolution resolution;
    int rounds = 9;
    /// None: the one that the tracer measures to be smaller.
    std::vector<std::optional<OctreeType>> types{OctreeType::kNonuniform, OctreeType::kUniform};
    /// Of nuvo's frames; Embree sees all faces, and nuvo's single rays do.
    BackFaces back_faces = BackFaces::kSolid;
    std::string isa;  ///< "avx512", "avx2", "sse4.2" or "sse2", for both; empty: the best
    std::string parts = "frame,check,rays,exactness,threads";
    std::optional<std::string> pov;       ///< write the scene for POV-Ray here and do nothing else
    std::optional<std::string> pictures;  ///< NAME: write NAME-ours.bmp and NAME-embree.bmp
};

/// One way of asking Embree and the least seconds it took in the survey.
struct SurveyRow {
    std::string what;
    double seconds = 0;
};

/// Every way of asking Embree that was tried, and the fastest.
struct Survey {
    std::string version;  ///< of Embree
    EmbreeOptions options;
    EmbreeMode mode;
    std::vector<SurveyRow> rows;
};

/// Tries build qualities, kinds of sphere, packet widths and flags, each by itself.
Survey survey_embree(const FloatScene& scene, const ContestOptions& options);

/// One octree type's samples, seconds but for the memory.
struct OurSamples {
    std::optional<OctreeType> type;
    Samples build;    ///< flattening included
    Samples scratch;  ///< build and first frame
    Samples frame;
    Samples tables;
    Samples primary;
    Samples shadow;
    Samples shading;
    FastMemory memory;
};

/// Embree's samples, seconds.
struct EmbreeSamples {
    Samples convert;  ///< to single precision; in none of the others
    Samples build;
    Samples scratch;
    Samples primary;
    Samples trace;  ///< primary and shadow rays
    Samples frame;
    EmbreeMemory memory;
};

/// How far the two pictures agree.
struct Agreement {
    std::size_t differing = 0;  ///< pixels that are not the same bytes
    std::size_t visible = 0;    ///< pixels off by more than kVisible in a channel
    static constexpr int kVisible = 8;
};

/// Frames and builds of both sides in turn.
struct FrameContest {
    std::vector<OurSamples> ours;
    EmbreeSamples embree;
    Agreement agreement;
};
FrameContest contest_frames(const Scene& scene, const ContestOptions& options,
                            const Survey& survey);

/// Pixels of our pictures, summed over the types, that are not the exact profile's: 0.
std::size_t pixels_unlike_exact(const Scene& scene, const ContestOptions& options);

/// Rays between random points of the scene's box, seconds for all of them.
struct RayContest {
    std::size_t rays = 0;
    std::size_t hits = 0;
    std::size_t differing = 0;  ///< Embree names another primitive, or none, or one more
    std::vector<Samples> ours;  ///< one a type
    Samples embree;
};
RayContest contest_rays(const Scene& scene, const ContestOptions& options, const Survey& survey);

/// A frame with and without the exact stages, seconds.
struct ExactnessPrice {
    Samples exact;
    Samples plain;
    std::size_t differing = 0;  ///< pixels that the exact stages change
};
ExactnessPrice price_of_exactness(const Scene& scene, const ContestOptions& options,
                                  std::optional<OctreeType> type);

/// A frame with one and two threads, seconds on the wall.
struct ThreadContest {
    Samples ours_one;
    Samples ours_two;
    Samples ours_build_one;
    Samples ours_build_two;
    Samples embree_one;
    Samples embree_two;
    bool same_bytes = true;
};
ThreadContest contest_threads(const Scene& scene, const ContestOptions& options,
                              const Survey& survey, std::optional<OctreeType> type);

/// The instruction set that the options name.
InstructionSet instruction_set(const std::string& name);

/// Writes the scene in the language of POV-Ray 3.7. Throws as to_float() does.
void write_povray(const Scene& scene, const Primitives& primitives, const std::string& file);

}  // namespace nuvo::bench
