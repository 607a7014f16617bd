#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace nuvo::cli_test {

namespace fs = std::filesystem;

/// How one run of the program ended.
struct Outcome {
    int exit_code = -1;  ///< -1: ended by a signal
    std::string out;
    std::string err;
};

inline std::string file_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs the real program in a folder of its own that lives as long as the test.
class ProgramTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::path(testing::TempDir()) / "nuvo-cli-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        base_ = name;
        folder_ = base_ / "run";
        fs::create_directory(folder_);
    }
    void TearDown() override { fs::remove_all(base_); }

    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    std::string content(const std::string& name) const { return file_text(folder_ / name); }
    bool exists(const std::string& name) const { return fs::exists(folder_ / name); }
    /// Names of all files in the folder, hidden ones too.
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_))
            names.insert(entry.path().filename().string());
        return names;
    }

    /// Starts the program in the folder; standard output goes to `out` if given, standard input
    /// comes from its file `in`.
    pid_t start(const std::vector<std::string>& arguments, const std::string& out = "",
                rlim_t memory_limit = RLIM_INFINITY, const std::string& in = "") const {
        std::vector<std::string> words = arguments;
        words.insert(words.begin(), NUVO_PROGRAM);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const std::string out_path = out.empty() ? (base_ / "stdout").string() : out;
        const std::string err_path = (base_ / "stderr").string();
        const pid_t child = ::fork();
        if (child < 0) throw std::runtime_error("no process");  // kill(-1) would end all others
        if (child != 0) return child;
        constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
        const int out_descriptor = ::open(out_path.c_str(), kFlags, 0600);
        const int err_descriptor = ::open(err_path.c_str(), kFlags, 0600);
        const rlimit memory{memory_limit, memory_limit};
        // What never ends shall fail, not hold up the tests.
        constexpr rlim_t kProcessorSeconds = 200;
        const rlimit processor{kProcessorSeconds, kProcessorSeconds};
        const std::string in_path = in.empty() ? "/dev/null" : (folder_ / in).string();
        const int in_descriptor = ::open(in_path.c_str(), O_RDONLY);
        if (::chdir(folder_.c_str()) == 0 && ::dup2(in_descriptor, STDIN_FILENO) >= 0 &&
            ::dup2(out_descriptor, STDOUT_FILENO) >= 0 &&
            ::dup2(err_descriptor, STDERR_FILENO) >= 0 &&
            ::setrlimit(RLIMIT_CPU, &processor) == 0 &&
            (memory_limit == RLIM_INFINITY || ::setrlimit(RLIMIT_AS, &memory) == 0))
            ::execv(NUVO_PROGRAM, pointers.data());
        ::_exit(127);
    }
    Outcome finish(pid_t child) const {
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(base_ / "stdout"),
                file_text(base_ / "stderr")};
    }
    /// `in`: the file of the folder that standard input is.
    Outcome run(const std::vector<std::string>& arguments, const std::string& in = "") const {
        return finish(start(arguments, "", RLIM_INFINITY, in));
    }

    /// The run failed as it must: this code, one line on standard error that holds all of `parts`,
    /// nothing on standard output and no file that was not there before.
    void expect_refused(const std::vector<std::string>& arguments, int exit_code,
                        const std::vector<std::string>& parts) const {
        const std::set<std::string> before = files();
        const Outcome outcome = run(arguments);
        const std::string& err = outcome.err;
        EXPECT_EQ(outcome.exit_code, exit_code) << err;
        EXPECT_EQ(err.rfind("nuvo: ", 0), 0u) << err;
        EXPECT_EQ(err.find('\n') + 1, err.size()) << err;
        for (const std::string& part : parts)
            EXPECT_NE(err.find(part), std::string::npos) << part << " is not in: " << err;
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(files(), before);
    }

    fs::path base_;
    fs::path folder_;  // the program's working directory
};

/// A sphere of radius 1 at the origin, a square of two triangles behind it, lit from the front.
inline const char* const kSmallScene = R"(<X3D version="3.0"><Scene>
<Viewpoint position="0 0 10"/>
<DirectionalLight direction="0 -0.6 -0.8"/>
<PointLight location="3 3 3"/>
<Shape><Appearance><Material diffuseColor="1 0 0"/></Appearance><Sphere radius="1"/></Shape>
<Transform translation="0 0 -2"><Shape><Appearance><Material/></Appearance>
<IndexedFaceSet coordIndex="0 1 2 3 -1">
<Coordinate point="-2 -2 0, 2 -2 0, 2 2 0, -2 2 0"/></IndexedFaceSet></Shape></Transform>
</Scene></X3D>)";

/// Spheres on a grid, enough to give the octrees something to divide.
inline std::string grid_scene(int side) {
    std::string text = "<Scene><Viewpoint position='0 0 30'/><DirectionalLight/>";
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z)
                text += "<Transform translation='" + std::to_string(3 * x - side) + " " +
                        std::to_string(3 * y - side) + " " + std::to_string(-2 * z - x) +
                        "'><Shape><Appearance><Material/></Appearance><Sphere radius='0.8'/>"
                        "</Shape></Transform>";
    return text + "</Scene>";
}

}  // namespace nuvo::cli_test
