#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "appearance.h"
#include "lights.h"
#include "meshes.h"
#include "nuvo/scene/x3d.h"
#include "placement.h"
#include "version.h"

namespace nuvo::x3d {

/// Walks the scene graph of a checked document, whose USEs are resolved, and gathers the Scene.
class SceneReader {
  public:
    SceneReader(Version version, const Limits& limits, Messages& messages)
        : version_(version),
          messages_(messages),
          materials_(messages),
          vertices_{limits.vertices} {}

    Scene read(const Element& scene, Headlight headlight);

  private:
    /// What the children of a grouping node share.
    struct Group {
        Placement placement;
        std::vector<std::size_t> scoped_lights;  // that light this group only
    };
    using Handler = void (SceneReader::*)(const Element&, Group&);

    /// The handler of a node's kind; null where it is not drawn.
    static Handler handler_of(std::string_view name);

    // The recursion, at most as deep as the document limit allows.
    void read_children(const Element& parent, const Placement& placement);
    void read_child(const Element& child, Group& group);
    void read_group(const Element& node, Group& group);
    void read_transform(const Element& node, Group& group);

    // The leaves.
    void read_shape(const Element& node, Group& group);
    void read_directional_light(const Element& node, Group& group);
    void read_point_light(const Element& node, Group& group);
    void read_spot_light(const Element& node, Group& group);
    void read_viewpoint_node(const Element& node, Group& group);
    void read_background_node(const Element& node, Group& group);
    void read_navigation_info(const Element& node, Group& group);

    void add_light(Light::Kind kind, const Element& node, Group& group);
    std::optional<Shape> read_geometry(const Element& node, const Placement& placement);
    std::optional<Shape> read_sphere(const Element& node, const Placement& placement);
    void close_scopes(const Group& group, std::size_t first_object);
    void add_headlight(Headlight headlight);

    Version version_;
    Messages& messages_;
    MaterialTable materials_;
    VertexBudget vertices_;
    Scene scene_;
    std::vector<const Element*> light_nodes_;  // beside scene_.lights
    // Of several bindable nodes of a kind the first in the document counts.
    bool has_viewpoint_ = false;
    bool has_background_ = false;
    std::optional<bool> headlight_;
};

}  // namespace nuvo::x3d
