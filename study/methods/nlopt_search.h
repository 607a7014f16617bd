#pragma once

#include <cstdint>
#include <optional>

#include "nuvo/octree/midpoint.h"

namespace nuvo::study {

/// NLopt's algorithms that the thesis names.
enum class Search { kMlslLdsSbplx, kMlslSbplx, kMlslCobyla, kIsres, kAuglagCobyla, kAuglagSbplx };

/// Minimises eq. 19 between the medians from the centre: 3 evaluations an object and
/// `max_evaluations` in all. None where a median lies on or outside a face. Deterministic.
std::optional<Point3> nlopt_midpoint(const SplitQuery& query, Search search,
                                     std::uint64_t* evaluations, int max_evaluations = 100);

/// The strategy.
MidpointStrategy nlopt_strategy(Search search, std::uint64_t* evaluations);

}  // namespace nuvo::study
