#include "scene_files.h"

#include <iostream>
#include <system_error>

#include "nuvo/app/clocks.h"
#include "nuvo/app/commands.h"
#include "nuvo/image/file_writer.h"

namespace nuvo::app {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error) return is_regular(a);
    return a.lexically_normal() == b.lexically_normal() && !fs::exists(a, error);
}

std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = '?';
    return text;
}

}  // namespace

LoadedScene load(const Options& options) {
    LoadedScene loaded;
    loaded.path = find_scene(options.file);
    const StageStopwatch watch;
    loaded.scene = x3d::read_file(
        loaded.path,
        {options.limits, options.headlight, options.viewpoint, options.strict, options.defaults()});
    loaded.parse_seconds = watch.seconds();
    for (const std::string& warning : loaded.scene.warnings)
        std::cerr << "nuvo: warning: " + one_line(loaded.path.string() + ": " + warning) + '\n';
    return loaded;
}

bool is_regular(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

void check_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        for (const fs::path& input : inputs)
            if (is_same_file(input, outputs[i]))
                throw UsageError(outputs[i].string() + ": would be overwritten, but it is read");
        for (std::size_t j = 0; j < i; ++j)
            if (is_same_file(outputs[j], outputs[i]))
                throw UsageError(outputs[i].string() + ": would be written twice");
        image::check_writable(outputs[i]);
    }
}

}  // namespace nuvo::app
