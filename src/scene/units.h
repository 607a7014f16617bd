#pragma once

#include "element.h"
#include "messages.h"

namespace nuvo::x3d {

/// The UNIT statements of a file: radians and meters in one of its units of angle and length.
struct Units {
    double angle = 1;
    double length = 1;
};

/// Reads the `unit` statements in the head of an X3D root. Throws Error for a conversionFactor that
/// is no positive number.
Units read_units(const Element& root, Messages& messages);

/// Turns what an element's fields give as angles into radians.
void convert_angles(Element& element, double angle_unit, ElementArena& arena);

}  // namespace nuvo::x3d
