#pragma once

#include <compare>

namespace nuvo::x3d {

/// The X3D element's `version`; 0.0 for a bare Scene and where none is given.
struct Version {
    int major = 0;
    int minor = 0;

    friend auto operator<=>(const Version&, const Version&) = default;
};

}  // namespace nuvo::x3d
