#pragma once

#include <string>
#include <string_view>

#include "mesh.h"

namespace nuvo::generator {

/// The shortest decimal text, without exponent, that reads back as `value`; -0 is written 0.
std::string number(double value);

/// Three numbers with blanks between them.
std::string triple(Point p);

/// Everything from the XML declaration to the opened Scene. The version is 3.0, which has no field
/// `global`: every light lights every shape.
std::string scene_head(std::string_view title, std::string_view description);

/// The closing tags that belong to scene_head.
std::string scene_foot();

/// The sky of the thesis' scenes (appendix E) and no light at the camera.
std::string sky_and_no_headlight();

enum class Shading { kFlat, kSmooth };

/// An IndexedTriangleSet without normals, so that the reader makes them: one per triangle (flat) or
/// the average at each corner (smooth). `def` names the node for USE; empty: no name.
std::string triangle_set(const Mesh& mesh, std::string_view def, Shading shading,
                         std::string_view indent);

/// An Appearance with one Material; `fields` are the Material's attributes as text.
std::string appearance(std::string_view fields, std::string_view def, std::string_view indent);

}  // namespace nuvo::generator
