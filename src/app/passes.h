#pragma once

#include "meter.h"
#include "nuvo/app/options.h"
#include "nuvo/app/report.h"
#include "nuvo/image/image.h"
#include "nuvo/scene/scene.h"

namespace nuvo::app {

/// The tile tracer as the options and the profile ask for it, nothing left open.
FastOptions fast_options(const Options& options, const Profile& profile, Progress* progress);

/// Builds and traces `repetitions` times by the profile's tracer; the last picture stays in
/// `picture`. Counts in runs of their own where the options want counts. [thesis 5.7.1]
Pass run_pass(const Scene& scene, const Options& options, const Profile& profile, int repetitions,
              Meter& meter, Image& picture);

/// The profile whose walk --planes, --heatmap, --octree and --pixel look at: the one given, or for
/// the tile tracer the serial one of the same picture, the exact profile, on an octree of the same
/// type.
Profile walked_profile(const Scene& scene, const Options& options, Meter& meter);

/// Renders with every primitive against every ray.
Pass run_brute_force(const Scene& scene, const Options& options, Meter& meter, Image& picture);

/// Builds once and answers the rays.
Pass run_rays(const Scene& scene, const Options& options, std::span<const Ray> rays, Meter& meter,
              std::vector<RayAnswer>& answers);

}  // namespace nuvo::app
