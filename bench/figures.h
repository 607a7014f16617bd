#pragma once

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "nuvo/app/clocks.h"
#include "nuvo/app/json_writer.h"
#include "nuvo/app/study.h"

namespace nuvo::bench {

/// What one round after the other measured, in one unit.
using Samples = std::vector<double>;

/// Processor seconds of this thread that `work` takes; its answer is put into `out`.
template <typename Work, typename Out>
double timed(Out& out, Work&& work) {
    const app::StageStopwatch watch;
    out = work();
    return watch.seconds();
}

/// The same for work without an answer.
template <typename Work>
double timed(Work&& work) {
    const app::StageStopwatch watch;
    work();
    return watch.seconds();
}

inline double least(const Samples& samples) {
    return *std::min_element(samples.begin(), samples.end());
}

inline double median(const Samples& samples) { return app::median_interval(samples).median; }

/// Writes median, its 95 % interval, the least and all samples; null if there are none.
inline void write_samples(app::JsonWriter& json, std::string_view name, const Samples& samples) {
    json.key(name);
    if (samples.empty()) return json.null();
    const app::MedianInterval interval = app::median_interval(samples);
    json.begin_object();
    json.member("median", interval.median);
    json.member("low", interval.low);
    json.member("high", interval.high);
    json.member("least", least(samples));
    json.member("samples", samples);
    json.end_object();
}

}  // namespace nuvo::bench
