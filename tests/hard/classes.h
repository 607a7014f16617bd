#pragma once

#include <span>

#include "aims.h"
#include "parts.h"

namespace nuvo::hard {

/// One way in which scenes and rays are hard.
struct HardClass {
    const char* name;
    Scene (*scene)(Random&);
    Ray (*ray)(const Scene&, Aims&, Random&);
    /// Trees may be cut down to two items a leaf; elsewhere many surfaces share a line, along which
    /// such a cut never ends.
    bool deep_trees = false;
};

/// Every class, in a fixed order (the seeds depend on it).
std::span<const HardClass> hard_classes();

/// The classes by what they are about: flat surfaces and the tree, round surfaces, place and scale.
std::span<const HardClass> mesh_classes();
std::span<const HardClass> round_classes();
std::span<const HardClass> place_classes();

}  // namespace nuvo::hard
