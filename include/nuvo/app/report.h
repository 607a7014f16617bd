#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "nuvo/app/clocks.h"
#include "nuvo/app/memory.h"
#include "nuvo/app/options.h"
#include "nuvo/image/compare.h"
#include "nuvo/octree/cost.h"
#include "nuvo/octree/octree.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/planes.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/scene.h"

namespace nuvo::app {

/// What a scene holds.
struct SceneCounts {
    std::size_t shapes = 0;     ///< Shapes met in the file, drawn or not
    std::size_t objects = 0;    ///< drawn
    std::size_t triangles = 0;  ///< with those of zero area
    std::size_t spheres = 0;    ///< ellipsoids included
    std::size_t lights = 0;     ///< headlight included
    std::size_t warnings = 0;
};
SceneCounts count(const Scene& scene);

/// How leaves lie and what they hold, the empty ones that an octree keeps included.
struct LeafHistogram {
    struct Level {
        std::size_t leaves = 0;
        double volume_share = 0;  ///< of the root
    };
    std::vector<Level> levels;       ///< by levels below the root
    std::vector<std::size_t> items;  ///< leaves of none, and at i > 0 of 2^(i-1) to 2^i - 1

    void add(std::size_t level, double volume_share, std::size_t item_count);
};

/// The final cost of an octree. [eq. 10]
struct FinalSah {
    double cost = 0;  ///< expected, of a ray that enters the root; NaN: the root has no surface
    SahCosts prices;  ///< by which cuts were judged
};

/// An octree in figures.
struct TreeFigures {
    int depth = 0;
    std::size_t voxels = 0;  ///< leaves, as the thesis counts
    std::size_t nodes = 0;
    std::size_t references = 0;
    std::size_t memory_bytes = 0;
    double smallest_width = 0;
    bool out_of_budget = false;  ///< cuts that pay were left out
    LeafHistogram leaves = {};
    std::size_t node_bytes = 0;  ///< memory_bytes are these, the references' and the names'
    std::size_t reference_bytes = 0;
    std::optional<FinalSah> sah = {};
};
/// All but the last.
TreeFigures figures(const Octree& octree);
FinalSah final_sah(const Octree& octree, const SahCosts& prices);

/// What the tile tracer has in place of TreeFigures and TraceCounts.
struct TileFigures {
    int threads = 1;
    InstructionSet isa = InstructionSet::kBest;
    int depth = 0;
    std::size_t voxels = 0;  ///< leaves; it keeps none that are empty
    std::size_t nodes = 0;
    std::size_t references = 0;
    FastMemory memory;
    LeafHistogram leaves = {};  ///< those with items
    std::optional<RayCounts> counts;
    std::optional<FastTimes> stage_seconds;  ///< of one picture
};
/// All but the last two.
TileFigures figures(const FastTracer& tracer, const FastOptions& options);

/// A heat map that was written.
struct HeatmapFigures {
    std::string file;
    HeatmapOf of = HeatmapOf::kTests;
    double largest = 0;    ///< value of the plane
    double scale_max = 0;  ///< the value at the top of the scale
};

/// The files by which others look at a pass.
struct LookFiles {
    std::optional<HeatmapFigures> heatmap;
    std::vector<std::string> planes;
    std::string octree;  ///< empty: none was written
};

/// One way of rendering the scene: its tree, its counts and every time taken.
struct Pass {
    std::string name;  ///< "uniform", "nonuniform", "serial" or "brute force"
    std::optional<TreeFigures> tree;
    std::optional<TraceCounts> counts;
    std::optional<TileFigures> tiles;   ///< tree and counts are then of walked_profile()
    std::optional<PixelPlanes> planes;  ///< if they were asked for
    std::optional<Octree> octree;       ///< if it is to be written
    LookFiles files;                    ///< made of these
    std::vector<double> build_seconds;  ///< one a repetition, summed over the threads
    std::vector<double> trace_seconds;
    std::vector<double> build_wall_seconds;
    std::vector<double> trace_wall_seconds;
    ProcessTimes process;  ///< around all repetitions
    PassMemory memory;
    std::vector<std::string> remarks;  ///< on the picture, a line each
};

/// Two passes of -compare.
struct Pair {
    std::string first;
    std::string second;
    image::Difference difference;
};

/// All that a run has to tell.
struct Report {
    std::string file;
    std::string picture;     ///< empty: none was written
    std::string difference;  ///< the difference picture; empty: none was written
    SceneCounts scene;
    RunMemory memory;
    double parse_seconds = 0;
    double write_seconds = 0;
    std::vector<std::string> warnings;  ///< of reading the scene
    double parse_wall_seconds = 0;
    double write_wall_seconds = 0;
    std::vector<Pass> passes;
    std::vector<Pair> pairs;
    std::optional<image::Difference> error;  ///< from the exact profile's picture
    std::optional<std::size_t> rays;         ///< queries answered
    std::optional<std::size_t> hits;
};

/// Whether the tile tracer chooses the octree's type by measuring the scene.
bool type_is_measured(const Options& options);
/// Every answer of a profile as the flags that give it.
std::string profile_flags_text(const Options& options);
/// The report for people, some lines.
std::string report_text(const Options& options, const Report& report);
/// The report for programs: JSON, numbers finite or null.
std::string report_json(const Options& options, const Report& report);

}  // namespace nuvo::app
