#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

/// The generator as a user meets it, and what its scenes say.
namespace nuvo::generator_test {

namespace fs = std::filesystem;

struct Outcome {
    int exit_code = -1;
    std::string text;
};

/// Runs the generator through the shell; `text` is what it wrote to standard output, or where the
/// arguments send the rest.
inline Outcome generate(const std::string& arguments) {
    Outcome outcome;
    const std::string command = std::string(NUVO_GENERATOR) + " " + arguments;
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return outcome;
    std::array<char, 65536> buffer;
    std::size_t count = 0;
    while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
        outcome.text.append(buffer.data(), count);
    }
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

inline std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string test_file(const std::string& name) {
    return read(fs::path(NUVO_SOURCE_DIR) / "testfiles" / (name + ".x3d"));
}

/// A folder that is empty at first and gone afterwards.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "nuvo_generator_XXXXXX").string();
        if (mkdtemp(name.data()) != nullptr) path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

inline std::size_t occurrences(std::string_view text, std::string_view word) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + word.size())) {
        ++count;
    }
    return count;
}

/// The numbers of every attribute that starts with `start`, in order.
inline std::vector<std::vector<double>> number_lists(const std::string& text,
                                                     const std::string& start) {
    std::vector<std::vector<double>> lists;
    for (auto at = text.find(start); at != text.npos; at = text.find(start, at + 1)) {
        const auto from = at + start.size();
        std::istringstream in(text.substr(from, text.find('\'', from) - from));
        lists.emplace_back(std::istream_iterator<double>(in), std::istream_iterator<double>());
    }
    return lists;
}

/// The scenes of testfiles/: all that need no --count.
inline std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    std::istringstream lines(generate("--list").text);
    for (std::string line; std::getline(lines, line);) {
        if (occurrences(line, "--count=N") == 0) names.push_back(line.substr(0, line.find(' ')));
    }
    return names;
}

}  // namespace nuvo::generator_test
