#pragma once

#include "fields.h"
#include "nuvo/scene/background.h"
#include "nuvo/scene/camera.h"
#include "placement.h"

namespace nuvo::x3d {

/// Reads a Viewpoint in world space. Scales move it but do not distort the view.
Camera read_viewpoint(const Fields& fields, const Placement& placement);

/// Reads a Background. Too few or too many angles for the colours are put right with a warning.
Background read_background(const Fields& fields);

}  // namespace nuvo::x3d
