#include "classes.h"

#include <vector>

namespace nuvo::hard {

std::span<const HardClass> hard_classes() {
    static const std::vector<HardClass> all = [] {
        std::vector<HardClass> classes;
        for (const auto part : {mesh_classes(), round_classes(), place_classes()})
            classes.insert(classes.end(), part.begin(), part.end());
        return classes;
    }();
    return all;
}

}  // namespace nuvo::hard
