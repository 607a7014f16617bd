#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>

#include "nuvo/app/rays.h"
#include "nuvo/image/npy.h"

namespace nuvo::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr Vector3 kNowhere{kNone, kNone, kNone};

Vector3 normal_at(const Triangle& triangle) {
    return normalized(cross(triangle.b - triangle.a, triangle.c - triangle.a));
}

Vector3 normal_at(const Shape& shape, const Point3& point, std::int64_t triangle) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
        return normal_at(mesh->triangle(static_cast<std::size_t>(triangle)));
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return normalized(point - sphere->center);
    // The gradient of |adj(linear) (p - center)|^2, halved.
    const auto& ellipsoid = std::get<Ellipsoid>(shape);
    const Matrix3 inward = ellipsoid.linear.adjugate();
    const Vector3 round = inward * (point - ellipsoid.center);
    return normalized(inward.transposed() * round);
}

/// Takes what is appended into one buffer, enlarged by large steps.
class Buffer {
  public:
    explicit Buffer(std::size_t bytes) { text_.reserve(bytes); }

    template <typename... How>
    void number(auto value, How... how) {
        std::array<char, 40> digits;
        const auto end =
            std::to_chars(digits.data(), digits.data() + digits.size(), value, how...).ptr;
        text_.append(digits.data(), end);
    }
    void real(double value) { number(value, std::chars_format::general, 17); }
    void vector(const Vector3& v) {
        for (const double x : {v.x, v.y, v.z}) {
            text_ += ' ';
            real(x);
        }
    }
    void bytes(const auto& value) {
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    std::string& text() { return text_; }

  private:
    std::string text_;
};

/// Empty for a miss.
std::string_view name_of(const RayAnswer& answer, std::span<const std::string> names) {
    return answer.hit ? std::string_view(names[static_cast<std::size_t>(answer.shape)])
                      : std::string_view();
}

}  // namespace

std::vector<HitPlace> hit_places(const Scene& scene, std::span<const Ray> rays,
                                 std::span<const RayAnswer> answers) {
    std::vector<const Object*> objects(scene.shape_count, nullptr);
    for (const Object& object : scene.objects) objects[object.shape_index] = &object;
    std::vector<HitPlace> places(answers.size(), HitPlace{kNowhere, kNowhere});
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (!answers[i].hit) continue;
        const Object& object = *objects[static_cast<std::size_t>(answers[i].shape)];
        places[i].point = rays[i].origin + rays[i].direction * answers[i].t;
        places[i].normal = normal_at(object.shape, places[i].point, answers[i].triangle);
    }
    return places;
}

std::string answers_text(std::span<const RayAnswer> answers, std::span<const HitPlace> places,
                         std::span<const std::string> names, const AnswerParts& parts) {
    constexpr std::size_t kUsualBytes = 32, kUsualVectorBytes = 60;
    Buffer out(answers.size() * (kUsualBytes + (parts.point ? kUsualVectorBytes : 0) +
                                 (parts.normal ? kUsualVectorBytes : 0)));
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const RayAnswer& answer = answers[i];
        if (answer.hit) {
            out.text() += "1 ";
            out.number(answer.shape);
            out.text() += ' ';
            out.number(answer.triangle);
            out.text() += ' ';
            out.real(answer.t);
        } else {
            out.text() += "0 -1 -1 inf";
        }
        if (parts.point) out.vector(places[i].point);
        if (parts.normal) out.vector(places[i].normal);
        if (parts.def) {
            const std::string_view name = name_of(answer, names);
            out.text() += name.empty() ? " -" : " ";
            for (const char c : name) out.text() += static_cast<unsigned char>(c) <= ' ' ? '_' : c;
        }
        out.text() += '\n';
    }
    return std::move(out.text());
}

std::string answers_npy(std::span<const RayAnswer> answers, std::span<const HitPlace> places,
                        std::span<const std::string> names, const AnswerParts& parts) {
    std::size_t name_bytes = parts.def ? 1 : 0;  // NumPy has no text of none
    if (parts.def)
        for (const RayAnswer& answer : answers)
            name_bytes =
                std::max(name_bytes, std::min(kMaxNameBytes, name_of(answer, names).size()));
    const std::array shape{answers.size()};
    const std::string header = image::npy_header(
        std::string("[('hit', '|b1'), ('shape', '<i8'), ('triangle', '<i8'), ('t', '<f8')") +
            (parts.point ? ", ('point', '<f8', (3,))" : "") +
            (parts.normal ? ", ('normal', '<f8', (3,))" : "") +
            (parts.def ? ", ('def', '|S" + std::to_string(name_bytes) + "')" : "") + "]",
        shape);
    const std::size_t record =
        1 + 3 * 8 + (parts.point ? 24u : 0u) + (parts.normal ? 24u : 0u) + name_bytes;
    Buffer out(header.size() + answers.size() * record);
    out.text() += header;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        out.bytes(answers[i].hit);
        out.bytes(answers[i].shape);
        out.bytes(answers[i].triangle);
        out.bytes(answers[i].t);
        if (parts.point) out.bytes(places[i].point);
        if (parts.normal) out.bytes(places[i].normal);
        if (parts.def) {
            const std::string_view name = name_of(answers[i], names).substr(0, name_bytes);
            out.text() += name;
            out.text().append(name_bytes - name.size(), '\0');
        }
    }
    return std::move(out.text());
}

}  // namespace nuvo::app
