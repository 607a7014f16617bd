#include "methods.h"

namespace nuvo::study {

MidpointStrategy median(Evaluations*) {
    return [](const SplitQuery& query) -> std::optional<Point3> {
        if (query.boxes.empty()) return std::nullopt;
        return Point3{object_median(query.boxes, 0), object_median(query.boxes, 1),
                      object_median(query.boxes, 2)};
    };
}

}  // namespace nuvo::study
