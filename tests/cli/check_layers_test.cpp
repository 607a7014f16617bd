#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

/// A tiny project in the shape of this one, on which the script must find what is planted.
class CheckLayers : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        plant("main.cpp", "int main() {}\n");
        plant("include/nuvo/math/vec.h", "#include <cmath>\n");
        plant("src/scene/x3d.cpp", "#include <boost/property_tree/ptree.hpp>\n");
        plant("src/octree/midpoint_nlopt.cpp", "#include <nlopt.hpp>\n");
        plant("src/app/options.cpp", "#include <boost/program_options.hpp>\n");
        plant("src/app/clocks.cpp", "#include <boost/chrono.hpp>\n");
        plant("src/scene/gunzip.cpp", "#include <zlib.h>\n");
        plant("src/scene/triangulation.cpp", "#include <geos_c.h>\n");
        plant("src/image/png.cpp", "#include <png.h>\n");
    }
    void plant(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        put(name, text);
    }
    /// What the script says; empty when it is content.
    std::string verdict() const {
        const std::string out = (base_ / "verdict").string();
        const std::string command = "bash '" NUVO_SOURCE_DIR "/scripts/check_layers.sh' '" +
                                    folder_.string() + "' >'" + out + "' 2>&1";
        const int status = std::system(command.c_str());
        const std::string said = file_text(out);
        EXPECT_EQ(WEXITSTATUS(status), said.empty() ? 0 : 1) << said;
        return said;
    }
};

TEST_F(CheckLayers, AnAllowedDirectionPasses) {
    plant("src/octree/build.cpp", "#include \"nuvo/math/vec.h\"\n");
    plant("src/app/commands.cpp", "#include \"nuvo/render/render.h\"\n");
    EXPECT_EQ(verdict(), "");
}

TEST_F(CheckLayers, AForbiddenDirectionIsFound) {
    plant("src/octree/build.cpp", "#include <vector>\n# include \"nuvo/geometry/shape.h\"\n");
    EXPECT_EQ(verdict(), "src/octree/build.cpp:2: octree must not include geometry\n");
    plant("src/octree/build.cpp", "");
    plant("include/nuvo/render/render.h", "#include \"nuvo/app/options.h\"\n");
    EXPECT_EQ(verdict(), "include/nuvo/render/render.h:1: render must not include app\n");
}

TEST_F(CheckLayers, AThirdPartyHeaderHasOneUserInItsRoom) {
    plant("src/app/report.cpp", "#include <boost/chrono/chrono.hpp>\n");
    EXPECT_NE(verdict().find("<boost/chrono> must be included in exactly one .cpp, not 2"),
              std::string::npos);
    fs::remove(folder_ / "src/app/report.cpp");
    fs::rename(folder_ / "src/octree/midpoint_nlopt.cpp", folder_ / "src/octree/midpoint.h");
    EXPECT_NE(verdict().find("src/octree/midpoint.h"), std::string::npos);
}

TEST_F(CheckLayers, AnUnknownLibraryOrRoomIsFound) {
    plant("src/image/threads.cpp", "#include <tbb/parallel_for.h>\n");
    EXPECT_NE(verdict().find("src/image/threads.cpp:1"), std::string::npos);
    fs::remove(folder_ / "src/image/threads.cpp");
    plant("src/attic/old.cpp", "");
    EXPECT_NE(verdict().find("attic"), std::string::npos);
}

}  // namespace
}  // namespace nuvo::cli_test
