#pragma once

#include "fast/shading/shading_tables.h"

namespace nuvo {

/// Fills the numbers of a chunk's triangles: `cosines` of each light that has room for them,
/// `normals`, `triangle_words` and `smooth` if they have room.
void fill_triangles(ShadingTables& tables, const TriangleChunk& chunk, InstructionSet isa);

/// The word of a primitive of that object.
SurfaceWord surface_word(const ShadingTables& tables, const Object& object);

}  // namespace nuvo
