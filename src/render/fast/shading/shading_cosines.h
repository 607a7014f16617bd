#pragma once

#include "fast/shading/shading_tables.h"

namespace nuvo {

/// Fills in what of ShadingTables::triangles has room for a chunk's.
void fill_triangles(ShadingTables& tables, const TriangleChunk& chunk, InstructionSet isa);

/// The word of a primitive of that object.
SurfaceWord surface_word(const ShadingTables& tables, const Object& object);

}  // namespace nuvo
