#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nuvo/render/fast.h"
#include "nuvo/render/profile.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::app {

inline constexpr int kMaxSidePixels = 16384;           ///< unless --max-side says otherwise
inline constexpr int kLargestMaxSide = 32768;          ///< a BMP file is smaller than 4 GiB
inline constexpr std::size_t kLargestMaxDepth = 8192;  ///< what the stack bears
inline constexpr int kMaxRepetitions = 1'000'000;
inline constexpr int kMaxThreads = 1024;
inline constexpr int kMaxSamples = 64;
/// The name that stands for standard input or output.
inline constexpr const char* kStandardStream = "-";

/// Which plane --heatmap paints.
enum class HeatmapOf { kTests, kSearches, kStage };

/// A pixel by its column and its row from the top, from 0 on.
struct Pixel {
    int x = 0;
    int y = 0;
};

/// What --rays tells beside the hit itself.
struct AnswerParts {
    bool point = false;
    bool normal = false;
    bool def = false;  ///< the shape's name
};

/// What the user typed, checked. Paths are as typed.
struct Options {
    std::string file = "testfiles/trianglemesh";  ///< .x3d may be missing
    int repetitions = 5;
    Resolution resolution;
    int samples = 1;  ///< a side of the square of exact pixels whose mean a pixel is
    std::string profile_name = "exact";  ///< the bundle that `profile` started from
    Profile profile;                     ///< with the single answers put in
    bool type_given = false;             ///< else the octree is the profile's own
    int threads = 1;                     ///< of the tile tracer; 0: one for each core
    InstructionSet isa = InstructionSet::kBest;
    x3d::Headlight headlight = x3d::Headlight::kAuto;
    std::string viewpoint;              ///< empty: the first
    std::optional<Point3> from;         ///< the camera's place instead of the file's
    std::optional<Point3> at;           ///< what it looks at
    std::optional<double> fov_degrees;  ///< the smaller angle of view
    bool strict = false;                ///< what could be left out of a scene refuses it
    x3d::Defaults (*defaults)() = &x3d::standard_defaults;  ///< else those of the profile
    x3d::Limits limits;
    int max_side_pixels = kMaxSidePixels;
    std::optional<std::string> rays;
    AnswerParts answer_parts;  ///< of the rays
    std::optional<std::string> out;
    std::optional<std::string> json;
    bool study = false;
    std::optional<std::string> study_json;
    bool show_octree = false;
    std::optional<HeatmapOf> heatmap;
    std::optional<double> heatmap_max;  ///< none: the largest value
    std::optional<std::string> planes;  ///< what the files' names begin with
    std::optional<std::string> octree;
    std::optional<Pixel> pixel;
    bool compare = false;
    bool compare_brute_force = false;  ///< with compare: by brute force, too
    bool error = false;                ///< against the exact profile's picture
    bool describe = false;
    bool counters = false;
    bool quiet = false;
    bool help = false;
    bool version = false;
    std::vector<std::string> arguments;  ///< as typed, all

    /// Whether each pixel's costs are to be recorded.
    bool wants_planes() const { return heatmap || planes; }
    /// Whether standard output is taken by bytes, so that the report goes to standard error.
    bool standard_output_taken() const;
    /// Whether a person on a terminal may be told how far long works are.
    bool shows_progress() const { return !quiet && !standard_output_taken(); }
    /// The resolution at which pictures are traced before samples are averaged.
    Resolution traced_resolution() const;
    /// `threads`, or how many cores there are.
    int thread_count() const;
};

/// A command line that cannot be obeyed: what() is one line that names flag and value.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// One row of the table of flags, from which the parser, -h and the documentation are made.
struct Flag {
    std::string name;      ///< without dashes
    std::string spelling;  ///< as the thesis writes it: "--file", "-compare"
    std::string value;     ///< syntax of the value; empty: a switch; "[=FILE]": may be missing
    std::string standard;  ///< the default as text; empty: none
    std::string help;
    /// Puts the value (empty for a switch) into the options. Throws UsageError with the reason
    /// only.
    void (*apply)(Options&, const std::string& value);
    std::string group = {};  ///< its heading in the help

    bool may_stand_alone() const { return value.starts_with('['); }
};

/// The table, in the order of the help. A flag that others refine stands before them, but for
/// --max-side, which the parser takes first.
const std::vector<Flag>& flags();

/// Reads the arguments (without the program's name): flags in any order, each at most once, with
/// one or two dashes, and a word that is no flag: the scene. Throws UsageError.
Options parse(const std::vector<std::string>& arguments);

/// The command list that -h prints.
std::string help_text();
/// The same table for the documentation, in Markdown.
std::string help_markdown();

}  // namespace nuvo::app
