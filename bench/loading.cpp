// What reading a scene costs beside a plain pass over the file: tags found by their brackets,
// values by their quotes, numbers by from_chars into vectors, and nothing checked, named, linked or
// built.
//   nuvo_loading FILE... [rounds]
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/scene/x3d.h"

namespace {

double processor_seconds() {
    std::timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

template <typename T>
void read_numbers(std::string_view text, std::vector<T>& numbers) {
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;;) {
        while (at != end && (*at <= ' ' || *at == ',')) ++at;
        T value{};
        const auto [after, error] = std::from_chars(at, end, value);
        if (error != std::errc{}) return;  // the end, or words
        numbers.push_back(value);
        at = after;
    }
}

/// Returns how many numbers there are.
std::size_t plain_pass(const char* path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw std::runtime_error(std::string(path) + ": cannot be opened");
    std::string text(static_cast<std::size_t>(file.tellg()), '\0');
    file.seekg(0);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    std::vector<double> numbers;
    std::vector<std::int32_t> indices;
    std::size_t at = 0;
    while ((at = text.find('<', at)) != std::string::npos) {
        ++at;
        if (text[at] == '!' || text[at] == '?' || text[at] == '/') continue;
        while (at < text.size() && text[at] != '>') {
            const std::size_t is = text.find_first_of("=>", at);
            if (is == std::string::npos || text[is] == '>') break;
            const std::size_t begin = is + 2;
            const std::size_t end = text.find(text[is + 1], begin);
            if (end == std::string::npos) break;
            const auto name = std::string_view(text).substr(at, is - at);
            const auto value = std::string_view(text).substr(begin, end - begin);
            if (name.ends_with("ndex"))
                read_numbers(value, indices);
            else
                read_numbers(value, numbers);
            at = end + 1;
        }
    }
    return numbers.size() + indices.size();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

void measure(const char* path, int rounds) {
    std::vector<double> plain, scene, ratio;
    std::size_t numbers = 0, shapes = 0;
    for (int i = 0; i < rounds; ++i) {
        const double begin = processor_seconds();
        numbers = plain_pass(path);
        const double between = processor_seconds();
        shapes = nuvo::x3d::read_file(path).shape_count;
        const double end = processor_seconds();
        plain.push_back(between - begin);
        scene.push_back(end - between);
        ratio.push_back(scene.back() / plain.back());
    }
    std::printf("%s: %zu numbers, %zu shapes; plain pass %.3f s, scene %.3f s, ratio %.2f\n", path,
                numbers, shapes, median(plain), median(scene), median(ratio));
}

}  // namespace

int main(int count, char** arguments) try {
    int rounds = 9;
    if (count > 2 && std::atoi(arguments[count - 1]) > 0) rounds = std::atoi(arguments[--count]);
    for (int i = 1; i < count; ++i) measure(arguments[i], rounds);
    return count > 1 ? 0 : 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "nuvo_loading: %s\n", error.what());
    return 1;
}
