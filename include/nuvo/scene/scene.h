#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "nuvo/geometry/shape.h"
#include "nuvo/scene/background.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/light.h"
#include "nuvo/scene/material.h"

namespace nuvo {

/// One drawn X3D Shape in world space.
struct Object {
    Shape shape;
    std::uint32_t material = 0;     ///< index into Scene::materials
    std::uint32_t shape_index = 0;  ///< the Shape's place in document order, USEs expanded
    /// Its back is invisible; false: it is seen, with the shading normal turned to the viewer.
    bool solid = true;
    bool casts_shadow = true;
};

/// What a file describes, in world space and double precision: the scene itself, not an
/// approximation of it. It holds no acceleration structure.
struct Scene {
    Camera camera;
    bool camera_given = false;  ///< by a Viewpoint; else it is the standard's
    Background background;
    std::vector<Material> materials;
    std::vector<Object> objects;          ///< in document order
    std::vector<Light> lights;            ///< on, in document order; the headlight, if any, last
    std::vector<std::string> warnings;    ///< what was read but not drawn, one line each
    std::size_t shape_count = 0;          ///< Shapes in the document, drawn or not
    std::vector<std::string> viewpoints;  ///< the names of those that can be chosen
};

}  // namespace nuvo
