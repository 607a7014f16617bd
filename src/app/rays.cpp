#include "nuvo/app/rays.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace nuvo::app {
namespace {

constexpr std::size_t kNumbers = 6;
constexpr std::string_view kBlanks = " \t\r\v\f";

/// The next word of the line, which is taken off it; empty at the end.
std::string_view next_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    return word;
}

/// The double nearest to a decimal number; false where it is none or beyond double.
bool parse_double(std::string_view word, double& value) {
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end) return false;
    if (error == std::errc::result_out_of_range)  // beyond double, or merely too small for it
        value = std::strtod(std::string(word).c_str(), nullptr);
    else if (error != std::errc())
        return false;
    return std::isfinite(value);
}

[[noreturn]] void fail(const std::string& name, std::size_t line, const std::string& reason) {
    throw RaysError(name + ": line " + std::to_string(line) + ": " + reason);
}

Ray parse_ray(std::string_view line, const std::string& name, std::size_t number) {
    std::array<double, kNumbers> v{};
    for (std::size_t i = 0; i < kNumbers; ++i) {
        const std::string_view word = next_word(line);
        if (word.empty()) fail(name, number, "a ray is 6 numbers, here are " + std::to_string(i));
        constexpr std::size_t kShown = 40;
        if (!parse_double(word, v[i]))
            fail(name, number,
                 "'" + std::string(word.substr(0, kShown)) + "' is not a finite number");
    }
    if (!next_word(line).empty()) fail(name, number, "a ray is 6 numbers, here are more");
    const Ray ray{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (ray.direction == Vector3{}) fail(name, number, "the direction is zero");
    return ray;
}

}  // namespace

std::vector<Ray> parse_rays(std::string_view text, const std::string& name) {
    std::vector<Ray> rays;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (line.find_first_not_of(kBlanks) != std::string_view::npos)
            rays.push_back(parse_ray(line, name, number));
    }
    return rays;
}

std::vector<Ray> read_rays(const std::filesystem::path& path) {
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::string text;
    std::array<char, 1 << 16> chunk;
    while (file) {
        file.read(chunk.data(), chunk.size());
        text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
    }
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) errno = EISDIR;
    if (!file.eof() || errno == EISDIR)
        throw RaysError(path.string() +
                        ": line 1: cannot read: " + std::generic_category().message(errno));
    return parse_rays(text, path.string());
}

std::string answers_text(std::span<const RayAnswer> answers) {
    std::string text;
    for (const RayAnswer& answer : answers) {
        if (!answer.hit) {
            text += "0 -1 -1 inf\n";
            continue;
        }
        std::array<char, 96> line;
        const int size = std::snprintf(line.data(), line.size(), "1 %lld %lld %.17g\n",
                                       static_cast<long long>(answer.shape),
                                       static_cast<long long>(answer.triangle), answer.t);
        text.append(line.data(), static_cast<std::size_t>(size));
    }
    return text;
}

}  // namespace nuvo::app
