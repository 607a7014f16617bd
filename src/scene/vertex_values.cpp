#include <algorithm>
#include <numbers>

#include "mesh_source.h"

namespace nuvo::x3d {

namespace {

/// The words of messages about one kind of values.
struct Words {
    const char* node;
    const char* field;
    const char* index_field;
    const char* plural;
};
constexpr Words kNormalWords{"Normal", "normal", "normalIndex", "normals"};
constexpr Words kColorWords{"Color", "color", "colorIndex", "colors"};

class Assignment {
  public:
    Assignment(MeshSource& source, const Spread& spread, CornerValues& values, const Words& words)
        : fields_(source.fields),
          polygons_(source.polygons),
          spread_(spread),
          values_(values),
          words_(words) {}

    void run() {
        if (!spread_.per_vertex)
            per_polygon();
        else if (spread_.index.empty())
            by_point();
        else
            by_index();
    }

  private:
    /// Values that the points' own indices choose.
    void by_point() {
        for (std::size_t c = 0; c < polygons_.corners.size(); ++c)
            checked(polygons_.corners[c], values_.values.size(), fields_, words_.field, c,
                    words_.plural);
        values_.values.resize(polygons_.points.size());  // to_mesh keeps them beside the points
    }

    void by_index() {
        values_.corners.reserve(polygons_.corners.size());
        for (std::size_t c = 0; c < polygons_.corners.size(); ++c)
            values_.corners.push_back(entry(spread_.entries ? (*spread_.entries)[c] : c));
    }

    void per_polygon() {
        values_.corners.reserve(polygons_.corners.size());
        for (std::size_t i = 0; i < polygons_.count(); ++i) {
            const std::size_t face = spread_.faces ? (*spread_.faces)[i] : i;
            const std::uint32_t value =
                spread_.index.empty()
                    ? checked(static_cast<std::int64_t>(face), values_.values.size(), fields_,
                              words_.field, face, words_.plural)
                    : entry(face);
            values_.corners.insert(values_.corners.end(), polygons_.ends[i + 1] - polygons_.ends[i],
                                   value);
        }
    }

    std::uint32_t entry(std::size_t i) const {
        if (i >= spread_.index.size())
            fields_.fail(words_.index_field, std::to_string(spread_.index.size()) +
                                                 " entries, but entry " + std::to_string(i) +
                                                 " is needed");
        return checked(spread_.index[i], values_.values.size(), fields_, words_.index_field, i,
                       words_.plural);
    }

    const Fields& fields_;
    Polygons& polygons_;
    const Spread& spread_;
    CornerValues& values_;
    const Words& words_;
};

/// Gives `values` to the polygons; ones that do not suit them are left out.
void assign(MeshSource& source, const Spread& spread, CornerValues& values, const Words& words) {
    if (values.values.empty()) return;
    try {
        if (!spread.per_vertex &&
            std::find(spread.index.begin(), spread.index.end(), -1) != spread.index.end()) {
            // Only an index per corner has -1 between the faces.
            if (source.messages.is_strict()) return Assignment(source, spread, values, words).run();
            source.fields.warn(words.index_field, "with -1 between entries, which is passed over");
            Spread without = spread;
            std::erase(without.index, -1);
            return Assignment(source, without, values, words).run();
        }
        Assignment(source, spread, values, words).run();
    } catch (const LeftOut& left_out) {
        source.messages.warn_left_out(words.node, left_out);
        values = {};
    }
}

/// ColorRGBA's colors; what is not opaque is drawn opaque.
std::vector<Color> read_rgba(const Fields& fields) {
    const Numbers numbers = fields.clamped_numbers("color", kUnit);
    if (numbers.size() % 4 != 0) {
        if (fields.is_strict())
            fields.refuse("color",
                          std::to_string(numbers.size()) + " numbers are no list of fours");
        fields.warn("color", "with an incomplete last color, which is left out");
    }
    std::vector<Color> colors;
    colors.reserve(numbers.size() / 4);
    bool opaque = true;
    for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
        colors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
        opaque = opaque && numbers[i + 3] == 1;
    }
    if (!opaque) fields.warn("color", "with alpha below 1: drawn opaque");
    return colors;
}

}  // namespace

void VertexBudget::take(std::size_t count, const Fields& fields) {
    if (count > limit - used)
        fields.refuse("", "the scene's meshes and round solids exceed the limit of " +
                              std::to_string(limit) +
                              " points, indices, normals and colors (--max-vertices)");
    used += count;
}

std::uint32_t checked(std::int64_t index, std::size_t count, const Fields& fields,
                      std::string_view field, std::size_t entry, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        fields.fail(field, "entry " + std::to_string(entry) + ": index " + std::to_string(index) +
                               " of " + std::to_string(count) + " " + what);
    return static_cast<std::uint32_t>(index);
}

void read_normals(MeshSource& source, const Spread& spread) {
    if (source.normal == nullptr) return;
    const Fields fields(*source.normal, source.messages, source.fields.threads());
    CornerValues& normals = source.polygons.normals;
    normals.values = fields.vectors("vector");
    source.budget.take(normals.values.size() + spread.index.size(), fields);
    assign(source, spread, normals, kNormalWords);
}

void read_colors(MeshSource& source, const Spread& spread) {
    if (source.color == nullptr) return;
    const Fields fields(*source.color, source.messages, source.fields.threads());
    CornerValues& colors = source.polygons.colors;
    colors.values = source.color->name == "ColorRGBA" ? read_rgba(fields) : fields.colors("color");
    source.budget.take(colors.values.size() + spread.index.size(), fields);
    assign(source, spread, colors, kColorWords);
}

void smooth(MeshSource& source, double crease_angle) {
    Polygons& polygons = source.polygons;
    if (crease_angle > 0 && crease_angle < std::numbers::pi) {
        // Every corner is compared with all faces at its point: so many comparisons count as one
        // point read.
        constexpr std::size_t kComparisons = 64;
        std::vector<std::size_t> faces(polygons.points.size());
        for (const std::uint32_t corner : polygons.corners) ++faces[corner];
        std::size_t work = 0;
        for (const std::size_t n : faces) work += n * n;
        source.budget.take(work / kComparisons, source.fields);
    }
    generate_normals(polygons, crease_angle, source.ccw);
}

}  // namespace nuvo::x3d
