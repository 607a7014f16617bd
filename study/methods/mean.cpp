#include "methods.h"

namespace nuvo::study {

MidpointStrategy mean(Evaluations*) {
    return [](const SplitQuery& query) -> std::optional<Point3> {
        if (query.boxes.empty()) return std::nullopt;
        Point3 sum;
        for (const Bounds3& box : query.boxes) sum += box.center();
        return sum / static_cast<double>(query.boxes.size());
    };
}

}  // namespace nuvo::study
