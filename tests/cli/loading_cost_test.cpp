// What loading may cost in memory, and in processor time where the build is optimised.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

class LoadingCost : public ProgramTest {
  protected:
    void expect_cost(const std::string& text, double seconds, long kilobytes) const {
        put("large.x3d", text);
        const pid_t child = start({"--file=large", "--describe"});
        int status = 0;
        rusage used{};
        ASSERT_EQ(::wait4(child, &status, 0, &used), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
#if defined(NDEBUG) && !defined(NUVO_SANITIZED)
        EXPECT_LT(static_cast<double>(used.ru_utime.tv_sec) +
                      static_cast<double>(used.ru_utime.tv_usec) * 1e-6,
                  seconds);
        EXPECT_LT(used.ru_maxrss, kilobytes);
#else
        static_cast<void>(seconds);
        static_cast<void>(kilobytes);
#endif
    }
};

TEST_F(LoadingCost, AMillionTrianglesTakeASecondAndHalfAGigabyteAtMost) {
    constexpr int kSide = 708;  // points a side: 2 * 707^2 triangles
    std::string index, points;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            points += std::to_string(x) + ".25 " + std::to_string(y) + ".5 " +
                      std::to_string(x * y % 17) + ".125 ";
    for (int y = 0; y + 1 < kSide; ++y)
        for (int x = 0; x + 1 < kSide; ++x) {
            const std::string a = std::to_string(y * kSide + x);
            const std::string c = std::to_string((y + 1) * kSide + x + 1);
            index += a + " " + std::to_string(y * kSide + x + 1) + " " + c + " -1 " + a + " " + c +
                     " " + std::to_string((y + 1) * kSide + x) + " -1 ";
        }
    expect_cost("<Scene><Shape><IndexedFaceSet creaseAngle='4' coordIndex='" + index +
                    "'><Coordinate point='" + points + "'/></IndexedFaceSet></Shape></Scene>",
                1, 500'000);
}

TEST_F(LoadingCost, AHundredThousandSpheresTakeASecondAndAQuarterGigabyteAtMost) {
    std::string text = "<Scene>";
    for (int i = 0; i < 100'000; ++i)
        text += "<Transform translation='" + std::to_string(i) +
                " 1 2'><Shape><Appearance><Material diffuseColor='1 0.5 0.25'/></Appearance>"
                "<Sphere radius='0.5'/></Shape></Transform>\n";
    expect_cost(text + "</Scene>", 1, 250'000);
}

}  // namespace
}  // namespace nuvo::cli_test
