#include "nuvo/render/profile.h"

namespace nuvo {
namespace {

// Of the factors 1, 0.1 .. 1e-5 tried on one view, this one loses the fewest pixels; no factor
// loses none (docs/thesis-map.md, section 4.4.4).
constexpr double kThesisStep = 0.0025;
// const float BIAS of thesis 5.3.2, in scene units.
constexpr double kThesisBias = 0.04;

}  // namespace

Profile thesis_profile() {
    Profile profile;
    profile.midpoint = MidpointChoice::kPublished;
    profile.costs = CostChoice::kThesis;
    profile.leaves = LeafContent::kShapes;
    profile.step = kThesisStep;
    profile.precision = Precision::kFloat;
    profile.bias = kThesisBias;
    profile.back_faces = BackFaces::kDraw;
    return profile;
}

Profile exact_profile() {
    Profile profile;
    profile.midpoint = MidpointChoice::kSweep;  // docs/midpoint-study.md
    return profile;
}

Profile fast_profile() {
    Profile profile = exact_profile();
    profile.tracer = TracerChoice::kTiles;
    profile.walk = WalkChoice::kDescent;
    return profile;
}

}  // namespace nuvo
