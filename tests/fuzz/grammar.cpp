#include "grammar.h"

#include <cmath>

#include "parts.h"

namespace nuvo::fuzz {
namespace {

using Elements = std::vector<Element>;

// What a document's Scene holds, in the making.
struct Content {
    Elements nodes;
    std::vector<Point3> hard_points;  // where lights and cameras are put
};

Element group(const char* name, Elements children) { return {name, {}, std::move(children)}; }

// A shape under transforms of its own, now and then with a light or the camera on it.
Element placed_shape(Chooser& choose, bool tip_heavy) {
    Elements inside{any_shape(choose, tip_heavy)};
    if (choose.once_in(16)) inside.push_back(any_light(choose, hard_point(choose)));
    if (choose.once_in(30)) {
        const Vector3 at = hard_point(choose);
        inside.push_back(viewpoint(choose, at, choose.point(3)));
    }
    Element placed = transformed(choose, group("Group", std::move(inside)));
    for (int depth = choose.once_in(3) ? choose.below(4) : 0; depth > 0; --depth)
        placed = transformed(choose, std::move(placed));
    return placed;
}

void add_uses(Chooser& choose, Content& content, Element node) {
    node.set("DEF", "a" + std::to_string(content.nodes.size()));
    const Element use{node.name, {{"USE", node.attributes.back().value}}, {}};
    content.nodes.push_back(std::move(node));
    for (int i = 1 + choose.below(3); i > 0; --i)
        content.nodes.push_back(choose.once_in(4) ? use : transformed(choose, use));
}

// A floor, a wall and things that are thin, flat or plain between them and the lamps.
void fill_room(Chooser& choose, Content& content) {
    const auto slab = [&](Vector3 size, Vector3 at) {
        content.nodes.push_back(moved(shape_of(choose, {"Box", {{"size", text(size)}}, {}}), at));
    };
    slab({10, 0.1, 10}, {0, -5, 0});
    if (choose.once_in(2)) slab({10, 10, 0.1}, {0, 0, -5});
    constexpr double kScales[] = {0.5, 0.5, 1, 2, 4, 0.1, 0.02, 1e-3, 1e-9};
    for (int i = 1 + choose.below(3); i > 0; --i) {
        const Vector3 scale{choose.one_of(kScales), choose.one_of(kScales), choose.one_of(kScales)};
        Element body =
            choose.once_in(4) ? any_shape(choose) : scaled(shape_of(choose, sphere(choose)), scale);
        if (choose.once_in(4)) body = transformed(choose, std::move(body));
        const Vector3 at = choose.point(4.5);
        content.hard_points.push_back(at);
        content.nodes.push_back(moved(std::move(body), at));
    }
    for (int i = choose.below(3); i > 0; --i) content.hard_points.push_back(choose.point(7));
}

void grow_freely(Chooser& choose, Content& content, bool tip_heavy) {
    for (int i = 1 + choose.below(8); i > 0; --i) {
        Element node = placed_shape(choose, tip_heavy);
        switch (choose.below(16)) {
            case 0:
                add_uses(choose, content, std::move(node));
                continue;
            case 1:
                node = {"Inline", {}, {std::move(node)}};
                break;
            case 2:
                node = {"Switch", {{"whichChoice", "0"}}, {std::move(node)}};
                break;
            case 3:
                node = {"LOD", {}, {std::move(node)}};
                break;
            default:
                break;
        }
        content.nodes.push_back(std::move(node));
    }
}

// One thing again and again: at the same place, moved or turned by next to nothing, or touching.
void coincide(Chooser& choose, Content& content) {
    const Element thing = any_shape(choose);
    constexpr double kMoves[] = {0, 0, 1e-320, 1e-60, 1e-17, 1e-16, 1e-15, 1e-9, 1e-3, 1, 2};
    for (int i = 2 + choose.below(choose.once_in(6) ? 40 : 8); i > 0; --i) {
        Vector3 move;
        move[choose.below(3)] = choose.one_of(kMoves);
        Element again = choose.once_in(2) ? thing : any_shape(choose);
        again = moved(std::move(again), move);
        if (choose.once_in(4)) again = scaled(std::move(again), {choose.nearly(1), 1, 1});
        content.nodes.push_back(std::move(again));
    }
}

// Small things far from each other.
void scatter(Chooser& choose, Content& content) {
    for (int i = 2 + choose.below(4); i > 0; --i) {
        Vector3 far;
        const int axis = choose.below(3);
        far[axis] = choose.signed_magnitude();
        if (choose.once_in(3)) far = {};
        if (choose.once_in(2)) content.hard_points.push_back(far);
        content.nodes.push_back(moved(any_shape(choose), far));
    }
}

Point3 place_of(Chooser& choose, const Content& content, double half) {
    if (!content.hard_points.empty() && choose.once_in(3)) {
        const int n = static_cast<int>(content.hard_points.size());
        const Point3 base = content.hard_points[static_cast<std::size_t>(choose.below(n))];
        return choose.once_in(2) ? base : base + hard_point(choose);
    }
    if (choose.once_in(4)) return hard_point(choose);
    return choose.point(half);
}

void add_view_and_lights(Chooser& choose, Content& content) {
    Elements first;
    const Point3 eye = choose.once_in(3) ? place_of(choose, content, 12)
                                         : Point3{choose.coordinate(4), choose.coordinate(4), 14};
    if (!choose.once_in(10)) first.push_back(viewpoint(choose, eye, choose.point(1.5)));
    if (choose.once_in(6))
        first.push_back(
            {"NavigationInfo", {{"headlight", choose.once_in(2) ? "true" : "false"}}, {}});
    if (choose.once_in(4))
        first.push_back(
            {"Background", {{"skyColor", choose.color()}, {"groundColor", choose.color()}}, {}});
    const int lights = choose.once_in(10) ? choose.below(13) : choose.below(4);
    for (int i = 0; i < lights; ++i)
        first.push_back(any_light(choose, place_of(choose, content, 8)));
    content.nodes.insert(content.nodes.begin(), first.begin(), first.end());
}

Resolution any_resolution(Chooser& choose) {
    constexpr Resolution kSizes[] = {{1, 1},  {2, 1},   {3, 2},   {1, 17},  {33, 1},
                                     {16, 9}, {17, 15}, {24, 14}, {32, 18}, {32, 18}};
    return choose.one_of(kSizes);
}

// Towards a place in the scene from anywhere, along axes, from very far, with odd lengths.
std::string any_ray(Chooser& choose, const Content& content) {
    const Point3 target = place_of(choose, content, 4);
    Point3 from = place_of(choose, content, 10);
    Vector3 d = target - from;
    if (choose.once_in(4)) {
        d = choose.direction();
        from = target - d * 8;
    }
    if (choose.once_in(5)) {
        const double far = choose.magnitude(1e290);
        from = target - d * far;
        if (choose.once_in(2)) d = target - from;
    }
    if (choose.once_in(5)) d = d * choose.magnitude();
    const double all = max_norm(from) + max_norm(d);
    if (d == Vector3{} || !std::isfinite(all)) return text(from = {0, 0, 9}) + " 0 0 -1";
    return text(from) + " " + text(d);
}

}  // namespace

Document make_document(std::uint64_t seed) {
    Chooser choose(seed);
    constexpr Numbers kNumbers[] = {Numbers::kIntegers, Numbers::kDecimals, Numbers::kDecimals,
                                    Numbers::kDoubles, Numbers::kExtreme};
    choose.numbers = choose.one_of(kNumbers);
    Content content;
    switch (choose.below(8)) {
        case 0:
        case 1:
            fill_room(choose, content);
            break;
        case 2:
            coincide(choose, content);
            break;
        case 3:
            scatter(choose, content);
            break;
        case 4:
            content.hard_points.emplace_back();
            content.hard_points.emplace_back(0, 1, 0);
            grow_freely(choose, content, true);
            break;
        default:
            grow_freely(choose, content, false);
    }
    add_view_and_lights(choose, content);
    Document document;
    if (choose.once_in(5)) {
        // 10^-307 .. 10^300, and below where numbers lose their digits.
        const double scale = choose.once_in(3)
                                 ? choose.magnitude()
                                 : std::pow(10, std::floor(choose.uniform(-322, 300)));
        content.nodes = {scaled(group("Group", std::move(content.nodes)), {scale, scale, scale})};
    }
    document.resolution = any_resolution(choose);
    for (int i = 24; i > 0; --i) document.rays.push_back(any_ray(choose, content));
    Element scene = group("Scene", std::move(content.nodes));
    constexpr const char* kVersions[] = {"3.0", "3.3", "3.3", "4.0"};
    document.root = choose.once_in(6)
                        ? scene
                        : Element{"X3D", {{"version", choose.one_of(kVersions)}}, {scene}};
    return document;
}

}  // namespace nuvo::fuzz
