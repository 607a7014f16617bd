#include "octree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "nuvo/app/json_writer.h"
#include "nuvo/image/file_writer.h"
#include "nuvo/image/viridis.h"
#include "nuvo/scene/camera.h"
#include "text.h"

namespace nuvo::app {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// The shortest digits that read back as the same double.
std::string digits(double number) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string digits(const Point3& p) { return digits(p.x) + ' ' + digits(p.y) + ' ' + digits(p.z); }

/// The leaves in the order of the nodes.
template <typename Use>
void for_each_voxel(const Octree& octree, Use&& use) {
    for (const Node& node : octree.nodes())
        if (node.is_leaf()) use(node, label_digits(node.label));
}

/// Collects small pieces into large ones.
class Chunks {
  public:
    explicit Chunks(const Sink& sink) : sink_(sink) {}
    void add(std::string_view piece) {
        text_ += piece;
        if (text_.size() >= kChunkBytes) end();
    }
    void end() {
        sink_(text_);
        text_.clear();
    }

  private:
    const Sink& sink_;
    std::string text_;
};

// ---- X3D

struct PointHash {
    std::size_t operator()(const Point3& p) const {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis)  // 0.0 and -0.0 are equal
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0)) * 0x9e3779b97f4a7c15;
        return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
};

/// The corners of some voxels, each once, and for each voxel one line along all of its edges.
class Wireframe {
  public:
    bool empty() const { return lines_.empty(); }
    void add(const Bounds3& box) {
        if (box.empty()) return;  // of a scene without shapes
        std::array<std::size_t, 8> corners;
        for (std::size_t bits = 0; bits < corners.size(); ++bits)
            corners[bits] = index_of({(bits & 1) != 0 ? box.max.x : box.min.x,
                                      (bits & 2) != 0 ? box.max.y : box.min.y,
                                      (bits & 4) != 0 ? box.max.z : box.min.z});
        // 12 edges, 3 of them twice: from each corner of a cube 3 edges leave, so that no line has
        // each once.
        for (const std::size_t corner : {0, 1, 3, 2, 0, 4, 5, 7, 6, 4, 5, 1, 3, 7, 6, 2})
            lines_ += std::to_string(corners[corner]) + ' ';
        lines_ += "-1\n";
    }
    void write(const std::string& name, Rgb8 color, Chunks& out) const {
        const auto channel = [](std::uint8_t c) { return format("%.3f", c / 255.0); };
        const std::string rgb = channel(color.r) + ' ' + channel(color.g) + ' ' + channel(color.b);
        out.add("<Shape DEF=\"" + name + "\"><Appearance><Material diffuseColor=\"" + rgb +
                "\" emissiveColor=\"" + rgb + "\"/></Appearance>\n<IndexedLineSet coordIndex=\"");
        out.add(lines_);
        out.add("\"><Coordinate point=\"");
        out.add(points_);
        out.add("\"/></IndexedLineSet></Shape>\n");
    }

  private:
    std::size_t index_of(const Point3& corner) {
        const auto [found, is_new] = indices_.try_emplace(corner, indices_.size());
        if (is_new) points_ += digits(corner) + '\n';
        return found->second;
    }

    std::unordered_map<Point3, std::size_t, PointHash> indices_;
    std::string points_;
    std::string lines_;
};

/// Where the whole of `box` is seen along -z with the standard's field of view.
Point3 viewpoint(const Bounds3& box) {
    const Vector3 widths = box.widths();
    const double half = std::max(widths.x, widths.y) / 2;
    const double slope = std::tan(Camera().field_of_view_rad / 2);
    Point3 eye = box.center();
    eye.z = box.max.z + 1.25 * half / slope;
    return eye;
}

std::string in_attribute(const std::string& text) {
    std::string out;
    for (const char c : valid_utf8(text)) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return out;
}

void write_x3d(const Octree& octree, const std::string& title, const Sink& sink) {
    Chunks out(sink);
    const Bounds3& root = octree.root().voxel.bounds;
    out.add(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<X3D profile=\"Interchange\" version=\"3.3\">\n<head>\n<meta name=\"title\" content=\"" +
        in_attribute(title) + "\"/>\n<meta name=\"description\" content=\"" +
        counted(octree.leaf_count(), "voxel") +
        ", one line each; colors by depth\"/>\n<meta name=\"generator\" content=\"nuvo " +
        NUVO_VERSION + "\"/>\n</head>\n<Scene>\n");
    if (!root.empty())
        out.add("<Viewpoint description=\"octree\" position=\"" + digits(viewpoint(root)) +
                "\" centerOfRotation=\"" + digits(root.center()) + "\"/>\n");
    std::vector<std::array<Wireframe, 2>> frames(static_cast<std::size_t>(octree.depth()));
    for_each_voxel(octree, [&](const Node& voxel, int depth) {
        frames[static_cast<std::size_t>(depth)][voxel.item_count == 0 ? 1 : 0].add(
            voxel.voxel.bounds);
    });
    // Colors from the first depth that has voxels to the last.
    const auto has_voxels = [](const auto& pair) { return !pair[0].empty() || !pair[1].empty(); };
    const auto first = static_cast<std::size_t>(
        std::find_if(frames.begin(), frames.end(), has_voxels) - frames.begin());
    for (std::size_t depth = first; depth < frames.size(); ++depth) {
        const double span = static_cast<double>(std::max(first + 1, frames.size() - 1) - first);
        const Rgb8 color = image::viridis(static_cast<double>(depth - first) / span);
        for (const bool is_empty : {false, true}) {
            const Wireframe& frame = frames[depth][is_empty ? 1 : 0];
            if (!frame.empty())
                frame.write(format("depth-%zu%s", depth, is_empty ? "-empty" : ""), color, out);
        }
    }
    out.add("</Scene>\n</X3D>\n");
    out.end();
}

// ---- JSON

std::string array(const Point3& p) {
    const auto number = [](double x) { return std::isfinite(x) ? digits(x) : "null"; };
    return '[' + number(p.x) + ',' + number(p.y) + ',' + number(p.z) + ']';
}

void write_json(const Octree& octree, const std::string& title, const Sink& sink) {
    Chunks out(sink);
    JsonWriter head;
    head.begin_object();
    head.member("octree", title);
    head.member("nuvo", NUVO_VERSION);
    head.member("voxels", octree.leaf_count());
    head.member("nodes", octree.nodes().size());
    head.member("references", octree.reference_count());
    head.member("levels", octree.depth());
    head.key("leaves");
    head.begin_array();
    head.end_array();
    head.end_object();
    const std::string text = head.text();
    const std::size_t inside = text.rfind(']');
    out.add(text.substr(0, inside));
    bool is_first = true;
    for_each_voxel(octree, [&](const Node& voxel, int depth) {
        out.add((is_first ? "\n" : ",\n") +
                format("    {\"name\": \"%llu\", \"depth\": %d, \"min\": ",
                       static_cast<unsigned long long>(voxel.label), depth) +
                array(voxel.voxel.bounds.min) + ", \"max\": " + array(voxel.voxel.bounds.max) +
                ", \"items\": " + std::to_string(voxel.item_count) + '}');
        is_first = false;
    });
    out.add("\n  " + text.substr(inside));
    out.end();
}

// ---- binary

std::string little_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

void write_binary(const Octree& octree, const std::string&, const Sink& sink) {
    constexpr std::uint32_t kNumbersOfAVoxel = 8;
    Chunks out(sink);
    out.add("nuvooct1");
    out.add(little_endian(static_cast<std::uint32_t>(octree.leaf_count())));
    out.add(little_endian(kNumbersOfAVoxel));
    for_each_voxel(octree, [&](const Node& voxel, int depth) {
        const Bounds3& box = voxel.voxel.bounds;
        for (const double number :
             {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z,
              static_cast<double>(depth), static_cast<double>(voxel.item_count)})
            out.add(little_endian(std::bit_cast<std::uint32_t>(static_cast<float>(number))));
    });
    out.end();
}

constexpr std::array kFormats{OctreeFormat{".x3d", write_x3d}, OctreeFormat{".json", write_json},
                              OctreeFormat{".bin", write_binary}};

}  // namespace

const OctreeFormat* octree_format(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending)
        if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    for (const OctreeFormat& format : kFormats)
        if (format.ending == ending) return &format;
    return nullptr;
}

void write_octree(const std::filesystem::path& path, const OctreeFormat& format,
                  const Octree& octree, const std::string& title) {
    image::FileWriter file(path);
    format.write(octree, title, [&file](std::string_view bytes) { file.write(bytes); });
    file.commit();
}

}  // namespace nuvo::app
