#include "units.h"

#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "fields.h"

namespace nuvo::x3d {

namespace {

/// Of fields with angles, the numbers from one angle to the next: a rotation is an axis and an
/// angle. Zero for all other fields.
std::size_t angle_stride(std::string_view node, std::string_view field) {
    if (node == "OrthoViewpoint" && field == "fieldOfView") return 0;  // lengths
    for (const char* rotation : {"rotation", "orientation", "scaleOrientation"})
        if (field == rotation) return 4;
    for (const char* angle :
         {"beamWidth", "creaseAngle", "cutOffAngle", "fieldOfView", "groundAngle", "skyAngle"})
        if (field == angle) return 1;
    return 0;
}

/// The numbers with each `stride`th multiplied; nothing where a word is no number, which whoever
/// reads the field will tell.
std::optional<std::string> multiplied(std::string_view numbers, std::size_t stride, double factor) {
    std::string result;
    std::size_t i = 0;
    for (std::string_view word = next_word(numbers); !word.empty(); word = next_word(numbers)) {
        if (!result.empty()) result += ' ';
        if (++i % stride != 0) {
            result += word;
            continue;
        }
        double value = 0;
        if (read_number(word, value) != NumberVerdict::kNumber) return std::nullopt;
        char text[32];
        result.append(text, std::to_chars(text, text + sizeof text, value * factor).ptr);
    }
    return result;
}

}  // namespace

Units read_units(const Element& root, Messages& messages) {
    Units units;
    bool has_angle = false, has_length = false;
    for (const Element& head : root.children) {
        if (head.name != "head") continue;
        for (const Element& unit : head.children) {
            if (unit.name != "unit") continue;
            const std::string_view category = unit.text("category");
            const bool is_angle = category == "angle";
            if (!is_angle && category != "length") continue;  // mass and force draw nothing
            const std::string_view text = unit.text("conversionFactor");
            std::string_view rest = text;
            double factor = 0;
            const bool is_number = read_number(next_word(rest), factor) == NumberVerdict::kNumber &&
                                   next_word(rest).empty();
            if (!is_number || !(factor > 0))
                messages.refuse(unit, "conversionFactor",
                                "\"" + excerpt(text) + "\" is no positive number");
            bool& has = is_angle ? has_angle : has_length;
            if (has)
                messages.warn("unit", "beyond the first of its category left out", unit);
            else
                (is_angle ? units.angle : units.length) = factor;
            has = true;
        }
    }
    return units;
}

void convert_angles(Element& element, double angle_unit, ElementArena& arena) {
    bool has_angles = false;
    for (const Attribute& a : element.attributes)
        has_angles |= angle_stride(element.name, a.name) > 0;
    if (!has_angles) return;
    const std::span<Attribute> changed = arena.make_attributes(element.attributes.size());
    for (std::size_t i = 0; i < changed.size(); ++i) {
        changed[i] = element.attributes[i];
        const std::size_t stride = angle_stride(element.name, changed[i].name);
        if (stride == 0) continue;
        const std::optional<std::string> text = multiplied(changed[i].value, stride, angle_unit);
        if (text) changed[i].value = arena.copy(*text);
    }
    element.attributes = changed;
}

}  // namespace nuvo::x3d
