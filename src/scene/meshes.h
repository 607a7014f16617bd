#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "fields.h"
#include "nuvo/geometry/triangle_mesh.h"
#include "placement.h"

namespace nuvo::x3d {

/// Points, normals and indices that the meshes of a scene may still read.
struct VertexBudget {
    std::size_t limit;
    std::size_t used = 0;

    /// Takes `count` of it; throws Error at the geometry `fields` when there is no more.
    void take(std::size_t count, const Fields& fields);
};

/// True for the geometry nodes that read_mesh reads.
bool is_mesh(std::string_view name);

/// Reads a geometry node as a mesh in world space; nothing when it has no triangles.
std::optional<TriangleMesh> read_mesh(const Element& geometry, const Placement& placement,
                                      Messages& messages, VertexBudget& budget);

}  // namespace nuvo::x3d
