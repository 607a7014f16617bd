#pragma once

#include <optional>

#include "methods.h"

namespace nuvo::study {

/// NLopt's algorithms that the thesis names.
enum class Search { kMlslLdsSbplx, kMlslSbplx, kMlslCobyla, kIsres, kAuglagCobyla, kAuglagSbplx };

/// Minimises eq. 19 between the medians from the centre: at most 3 evaluations an object. None
/// where a median lies on or outside a face. Deterministic.
std::optional<Point3> nlopt_midpoint(const SplitQuery& query, Search search,
                                     Evaluations* evaluations);

/// The strategy.
MidpointStrategy nlopt_strategy(Search search, Evaluations* evaluations);

}  // namespace nuvo::study
