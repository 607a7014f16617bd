#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/app/options.h"
#include "nuvo/image/compare.h"
#include "nuvo/render/render.h"

/// Speed against error: one scene rendered with every combination of answers worth comparing.
namespace nuvo::app {

/// A combination: a named profile and the flags that change it.
struct StudyCase {
    std::string profile;
    std::string change;  ///< as typed, separated by blanks; empty: the profile as it is
    Profile answers;
};

/// The combinations, the exact profile first: its picture is the truth. The type given is that of
/// all cases but those that change it; --midpoint and --max-objects hold for all.
std::vector<StudyCase> study_cases(const Profile& given);

/// A median and the percentile bootstrap's 95 % interval of it.
struct MedianInterval {
    double median = 0;
    double low = 0;
    double high = 0;
};
/// `values` must not be empty. Deterministic.
MedianInterval median_interval(std::span<const double> values);

/// A case measured. Pixels are wrong against the exact profile.
struct StudyRow {
    StudyCase what;
    std::vector<double> build_seconds;  ///< one a round
    std::vector<double> trace_seconds;
    MedianInterval trace;
    double build_median = 0;
    /// Pixels that show another primitive, and those of the right primitive, lit by other lights;
    /// none for the tile tracer, which tells colors only.
    std::optional<std::size_t> wrong_primitives;
    std::optional<std::size_t> wrong_shadows;
    image::Difference difference;  ///< of the pictures
    bool on_frontier = false;
};

/// Marks the rows that no other row beats: as fast with as little RMS, and better in one of them.
void mark_frontier(std::vector<StudyRow>& rows);

/// Renders all cases in options.repetitions rounds and compares them.
std::vector<StudyRow> run_study(const Scene& scene, const Options& options);

/// The table for people.
std::string study_text(const Options& options, const std::string& file,
                       const std::vector<StudyRow>& rows);
/// The same for programs: JSON, numbers finite or null.
std::string study_json(const Options& options, const std::string& file,
                       const std::vector<StudyRow>& rows);

}  // namespace nuvo::app
