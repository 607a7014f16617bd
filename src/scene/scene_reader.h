#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "appearance.h"
#include "documents.h"
#include "lights.h"
#include "meshes.h"
#include "node_names.h"
#include "nuvo/scene/x3d.h"
#include "placement.h"
#include "repeats.h"
#include "version.h"

namespace nuvo::x3d {

/// Walks the scene graph of checked documents, whose USEs are resolved, and gathers the Scene.
class SceneReader {
  public:
    SceneReader(const Documents& documents, const ReadOptions& options, Messages& messages)
        : documents_(documents),
          options_(options),
          messages_(messages),
          materials_(messages, options.defaults),
          vertices_{options.limits.vertices} {}

    Scene read(const Document& document);

  private:
    /// What the children of a grouping node share.
    struct Group {
        Placement placement;
        std::vector<std::size_t> scoped_lights;  // that light this group only
    };

    // The recursion, at most as deep as the document limit allows.
    void read_children(const Element& parent, const Placement& placement);
    void read_only(const Element* child, const Element& parent, const Placement& placement);
    void read_child(const Element& child, Group& group);
    void read_node(NodeKind kind, const Element& node, Group& group);
    void read_layers(const Element& node, Group& group);
    void read_switch(const Element& node, Group& group);
    void read_level_of_detail(const Element& node, Group& group);
    void read_inline(const Element& node, Group& group);
    /// Counts the Shapes of what is not drawn.
    void count_hidden(const Element& node);

    // The leaves.
    void read_shape(const Element& node, Group& group);
    void read_viewpoint_node(const Element& node, Group& group);
    void read_background_node(const Element& node, const Group& group);
    void read_navigation_info(const Element& node);

    void find_camera_first(const Element& scene);
    void check_viewpoint() const;
    void add_light(Light::Kind kind, const Element& node, Group& group);
    const Element* appearance_inside(const Element& geometry);
    std::optional<Shape> read_geometry(const Element& node, const Placement& placement);
    std::optional<Shape> read_sphere(const Element& node, const Placement& placement);
    void warn_of_idle_lights();
    void close_scopes(const Group& group, std::size_t first_object);
    void add_headlight();

    const Documents& documents_;
    const ReadOptions& options_;
    Messages& messages_;
    MaterialTable materials_;
    VertexBudget vertices_;
    Version version_;                  // of the file that is being read
    double length_unit_ = 1;           // of the scene's own file, in meters
    std::string file_;                 // in messages
    std::size_t inline_depth_ = 0;     // above 0 nothing is bound
    bool looking_for_camera_ = false;  // and for nothing else
    std::string_view name_;            // DEF of the nearest node around that has one
    Scene scene_;
    Repeats repeats_;
    std::vector<const Element*> light_nodes_;  // beside scene_.lights
    // Of several bindable nodes of a kind the first in the document counts, or the Viewpoint that
    // was asked for.
    bool has_background_ = false;
    std::optional<bool> headlight_;
};

}  // namespace nuvo::x3d
