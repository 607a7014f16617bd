#include "nuvo/app/rays.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <system_error>

#include "nuvo/image/npy.h"
#include "scene_files.h"

namespace nuvo::app {
namespace {

constexpr std::size_t kNumbers = 6;

constexpr bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// What may stand between two numbers: blanks, with one comma among them.
const char* skip_separator(const char* at, const char* end) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end || *at != ',') return at;
    ++at;
    while (at != end && is_blank(*at)) ++at;
    return at;
}

const char* word_end(const char* at, const char* end) {
    return std::find_if(at, end, [](char c) { return is_blank(c) || c == ','; });
}

/// The double nearest to a decimal number; false where it is none or beyond double.
bool parse_double(const char* begin, const char* end, double& value) {
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (stop != end) return false;
    if (error == std::errc::result_out_of_range)  // beyond double, or merely too small for it
        value = std::strtod(std::string(begin, end).c_str(), nullptr);
    else if (error != std::errc())
        return false;
    return std::isfinite(value);
}

[[noreturn]] void fail(const std::string& name, const char* unit, std::size_t number,
                       const std::string& reason) {
    throw RaysError(name + ": " + unit + " " + std::to_string(number) + ": " + reason);
}

Ray ray_of(const double* v, const std::string& name, const char* unit, std::size_t number) {
    const Ray ray{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (ray.direction == Vector3{}) fail(name, unit, number, "the direction is zero");
    return ray;
}

/// A line that holds something, from its first word on.
Ray parse_ray(const char* at, const char* end, const std::string& name, std::size_t number) {
    std::array<double, kNumbers> v{};
    for (std::size_t i = 0; i < kNumbers; ++i) {
        if (i > 0) at = skip_separator(at, end);
        if (at == end)
            fail(name, "line", number, "a ray is 6 numbers, here are " + std::to_string(i));
        const char* const stop = word_end(at, end);
        constexpr std::ptrdiff_t kShown = 40;
        if (!parse_double(at, stop, v[i]))
            fail(name, "line", number,
                 "'" + std::string(at, at + std::min(stop - at, kShown)) +
                     "' is not a finite number");
        at = stop;
    }
    if (std::find_if_not(at, end, is_blank) != end)
        fail(name, "line", number, "a ray is 6 numbers, here are more");
    return ray_of(v.data(), name, "line", number);
}

std::vector<Ray> rays_of_array(std::string_view bytes, const std::string& name) {
    std::vector<double> values;
    try {
        const image::NpyArray array = image::parse_npy(bytes);
        if (array.shape.size() != 2 || array.shape[1] != kNumbers)
            throw image::NpyError("is not of n x 6 numbers, a ray a row");
        values = image::npy_doubles(array);
    } catch (const image::NpyError& error) {
        throw RaysError(name + ": array: " + error.what());
    }
    std::vector<Ray> rays;
    rays.reserve(values.size() / kNumbers);
    for (std::size_t i = 0; i < values.size(); i += kNumbers) {
        const double* const v = values.data() + i;
        const std::size_t row = i / kNumbers;
        if (!std::all_of(v, v + kNumbers, [](double x) { return std::isfinite(x); }))
            fail(name, "row", row, "a number is not finite");
        rays.push_back(ray_of(v, name, "row", row));
    }
    return rays;
}

}  // namespace

std::vector<Ray> parse_rays(std::string_view text, const std::string& name) {
    if (image::is_npy(text)) return rays_of_array(text, name);
    std::vector<Ray> rays;
    rays.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
    std::size_t number = 0;
    const char* const last = text.data() + text.size();
    for (const char* line = text.data(); line != last;) {
        const char* const end = std::find(line, last, '\n');
        ++number;
        const char* const content = std::find(line, end, '#');
        const char* const first = std::find_if_not(line, content, is_blank);
        if (first != content) rays.push_back(parse_ray(first, content, name, number));
        line = end == last ? last : end + 1;
    }
    return rays;
}

std::vector<Ray> read_rays(const std::filesystem::path& path) {
    if (path == kStandardStream)
        return parse_rays(read_standard_input(std::numeric_limits<std::size_t>::max()),
                          "standard input");
    std::error_code ignored;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::string text;
    std::uintmax_t size = std::filesystem::file_size(path, ignored);
    if (ignored) size = 0;  // a pipe or a device
    text.reserve(size);
    std::vector<char> chunk(1 << 18);
    while (file) {
        file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
        text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (std::filesystem::is_directory(path, ignored)) errno = EISDIR;
    if (errno == ENOMEM) throw std::bad_alloc();
    if (!file.eof() || errno == EISDIR)
        throw RaysError(path.string() + ": cannot read: " + std::generic_category().message(errno));
    if (text.size() < size)
        throw RaysError(path.string() + ": cannot read: it ends after " +
                        std::to_string(text.size()) + " of its " + std::to_string(size) + " bytes");
    return parse_rays(text, path.string());
}

}  // namespace nuvo::app
