#pragma once

#include <optional>
#include <string_view>

#include "mesh_source.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/scene/x3d.h"
#include "placement.h"

namespace nuvo::x3d {

/// True for the geometry nodes that read_mesh reads.
bool is_mesh(std::string_view name);

/// Reads a geometry node as a mesh in world space; nothing when it has no triangles.
std::optional<TriangleMesh> read_mesh(const Element& geometry, const Placement& placement,
                                      const ReadOptions& options, Messages& messages,
                                      VertexBudget& budget);

}  // namespace nuvo::x3d
