#pragma once

#include "chooser.h"
#include "document.h"

/// What the grammar's documents are made of.
namespace nuvo::fuzz {

/// A Shape of any geometry; `tip_heavy`: mostly those with corners where many faces meet.
Element any_shape(Chooser& choose, bool tip_heavy = false);
/// A Shape with that geometry and any appearance.
Element shape_of(Chooser& choose, Element geometry);
/// A Sphere, most often of radius 1.
Element sphere(Chooser& choose);
/// Any geometry but solids: meshes of every kind of node.
Element any_mesh(Chooser& choose);

/// `child` in a Transform: moved, turned, scaled; now and then flat, sheared or extreme.
Element transformed(Chooser& choose, Element child);
/// `child` in a Transform of that scale.
Element scaled(Element child, const Vector3& factors);
Element moved(Element child, const Vector3& by);

/// A light; `place` is where it stands, if it stands anywhere.
Element any_light(Chooser& choose, const Point3& place);
/// A Viewpoint or OrthoViewpoint at `place` that looks towards `target`, or along an axis.
Element viewpoint(Chooser& choose, const Point3& place, const Point3& target);
/// A point at which things are hard, of a shape that stands at the origin and has about size 1.
Point3 hard_point(Chooser& choose);

}  // namespace nuvo::fuzz
