#pragma once

#include "shading_tables.h"

namespace nuvo {

/// Fills the numbers of all triangles: `facing` of each light that has room for them, `normals` if
/// they have room, `triangle_words` if they have room.
void fill_triangles(ShadingTables& tables, InstructionSet isa);

/// The word of a primitive of that object.
SurfaceWord surface_word(const ShadingTables& tables, const Object& object);

}  // namespace nuvo
