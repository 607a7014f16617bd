#pragma once

#include <cstddef>
#include <string>

#include "fields.h"
#include "nuvo/scene/background.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/defaults.h"
#include "placement.h"

namespace nuvo::x3d {

/// Reads a Viewpoint or an OrthoViewpoint in world space. Scales move it but do not distort the
/// view.
Camera read_viewpoint(const Fields& fields, const Placement& placement, const Defaults& defaults);

/// The name of a Viewpoint: its DEF, else its description, else its number.
std::string viewpoint_name(const Element& node, std::size_t number);

/// True where `wanted` is the Viewpoint's DEF, description or number (from 1), or empty.
bool is_wanted(const Element& node, std::size_t number, const std::string& wanted);

/// Reads a Background or the colours of a TextureBackground, which their ancestors turn but neither
/// move nor scale (ISO/IEC 19775-1, 24.4.1). Too few or too many angles for the colours are put
/// right with a warning.
Background read_background(const Fields& fields, const Placement& placement);

}  // namespace nuvo::x3d
