// Faults of the system while the program reads: refused in one line, never another picture. The
// calls fail by tests/faults/shim.c; scripts/faults.sh tries all of them.
#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

class Faults : public ProgramTest {
  protected:
    void SetUp() override {
        if (std::string(NUVO_FAULT_SHIM).empty()) GTEST_SKIP() << "sanitizers have an allocator";
        ProgramTest::SetUp();
        put("scene.x3d", R"(<X3D version="3.3"><Scene><Viewpoint position="0 0 8"/><PointLight/>
<Inline url='"part.x3d"'/></Scene></X3D>)");
        put("part.x3d", R"(<X3D version="3.3"><Scene><Shape><Appearance><Material/></Appearance>
<Sphere/></Shape></Scene></X3D>)");
    }
    void TearDown() override {
        ::unsetenv("LD_PRELOAD");
        ::unsetenv("NUVO_FAULT");
        ::unsetenv("NUVO_FAULT_ONLY");
        if (!base_.empty()) ProgramTest::TearDown();
    }
    /// In the next runs the calls of `fault` fail (tests/faults/shim.c), of opens those of names
    /// that hold `only`.
    void break_calls(const std::string& fault, const std::string& only = "") const {
        ::setenv("LD_PRELOAD", NUVO_FAULT_SHIM, 1);
        ::setenv("NUVO_FAULT", fault.c_str(), 1);
        ::setenv("NUVO_FAULT_ONLY", only.c_str(), 1);
    }

    const std::vector<std::string> render_{"--file=scene.x3d", "--res=8,6", "--rep=1",
                                           "--out=a.bmp"};
};

TEST_F(Faults, AnInlineThatTheSystemCannotOpenIsRefused) {
    for (const int error : {EMFILE, ENFILE, EIO})
        for (const int call : {1, 2}) {  // to see whether it can be opened, and to read it
            break_calls("open:" + std::to_string(call) + ":" + std::to_string(error), "part.x3d");
            expect_refused(render_, 3, {"part.x3d: cannot be opened: ", ::strerror(error)});
        }
}

// Its name is resolved and it is opened with memory; the scene's folder, too, which tells what lies
// within it.
TEST_F(Faults, OutOfMemoryNeverLeavesAnInlineOut) {
    const auto below_its_time = [](const std::string& out) { return out.substr(out.find('\n')); };
    const Outcome right = run({"scene.x3d", "--describe"});
    ASSERT_EQ(right.exit_code, 0);
    int out_of_memory = 0;
    for (int call = 520; call < 560; ++call) {
        break_calls("alloc:" + std::to_string(call) + ":12");
        const Outcome outcome = run({"scene.x3d", "--describe"});
        if (outcome.exit_code == 0) {
            EXPECT_EQ(below_its_time(outcome.out), below_its_time(right.out))
                << call << ": " << outcome.err;
        } else {
            EXPECT_EQ(outcome.exit_code, 4) << call << ": " << outcome.err;
            ++out_of_memory;
        }
    }
    EXPECT_GT(out_of_memory, 20);
}

TEST_F(Faults, AnInlineThatIsNotThereIsLeftOutWithAWarning) {
    for (const int error : {ENOENT, EACCES, ELOOP}) {
        break_calls("open:1:" + std::to_string(error), "part.x3d");
        const Outcome outcome = run(render_);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_NE(outcome.err.find("Inline@url"), std::string::npos) << outcome.err;
    }
}

TEST_F(Faults, AnErrorOrAnEarlyEndOfAFileIsRefused) {
    put("rays.txt", "0 0 8 0 0 -1\n");
    int refused = 0;
    for (const std::string what : {"5", "zero"})
        for (int call = 1; call < 20; ++call) {
            break_calls("read:" + std::to_string(call) + ":" + what);
            const Outcome outcome = run({"--file=scene.x3d", "--rays=rays.txt", "--out=hits.txt"});
            EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 3) << outcome.err;
            refused += outcome.exit_code == 3 ? 1 : 0;
            EXPECT_EQ(exists("hits.txt"), outcome.exit_code == 0);
            if (outcome.exit_code == 0) {
                EXPECT_EQ(content("hits.txt"), "1 0 0 7\n") << what << " " << call;
            }
            fs::remove(folder_ / "hits.txt");
        }
    EXPECT_GE(refused, 6);  // the scene, its Inline and the rays, for each
}

TEST_F(Faults, AnErrorOfStandardInputIsTold) {
    fs::create_directory(folder_ / "folder");
    for (const std::vector<std::string>& flags :
         {std::vector<std::string>{"--file=-", "--out=a.bmp"},
          std::vector<std::string>{"--file=scene.x3d", "--rays=-", "--out=a.txt"}}) {
        const Outcome outcome = run(flags, "folder");  // reading a folder is an error
        EXPECT_EQ(outcome.exit_code, 3);
        EXPECT_EQ(outcome.err, "nuvo: standard input: cannot be read\n");
        EXPECT_FALSE(exists("a.bmp") || exists("a.txt"));
    }
}

}  // namespace
}  // namespace nuvo::cli_test
