// What a person on a terminal sees of a long run: a pseudo-terminal stands for it.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

constexpr const char* kEraseLine = "\r\033[K";
// Until then a line must have come; nothing waits so long when all is well.
constexpr auto kPatience = std::chrono::seconds(60);

class ProgressLine : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        int terminal = -1;
        if (::openpty(&screen_, &terminal, nullptr, nullptr, nullptr) != 0)
            GTEST_SKIP() << "the system has no pseudo-terminals (/dev/pts)";
        ::close(terminal);
        ::close(screen_);
    }

    /// Starts the program with standard error on a terminal, and standard output as well if asked.
    void start_on_terminal(const std::vector<std::string>& arguments, bool with_output = false) {
        int terminal = -1;
        if (::openpty(&screen_, &terminal, nullptr, nullptr, nullptr) != 0 || ::pipe(input_) != 0)
            throw std::runtime_error("no terminal or no pipe");
        std::vector<std::string> words = arguments;
        words.insert(words.begin(), NUVO_PROGRAM);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const std::string out_path = (base_ / "stdout").string();
        child_ = ::fork();
        if (child_ < 0) throw std::runtime_error("no process");  // kill(-1) would end all others
        if (child_ != 0) {
            ::close(terminal);
            ::close(input_[0]);
            return;
        }
        const int out =
            with_output ? terminal : ::open(out_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::close(input_[1]);
        if (::chdir(folder_.c_str()) == 0 && ::dup2(input_[0], STDIN_FILENO) >= 0 &&
            ::dup2(out, STDOUT_FILENO) >= 0 && ::dup2(terminal, STDERR_FILENO) >= 0)
            ::execv(NUVO_PROGRAM, pointers.data());
        ::_exit(127);
    }

    /// What the terminal shows more within the patience, until it holds `wanted` or the program has
    /// ended.
    bool wait_for(const std::string& wanted) {
        const auto last = std::chrono::steady_clock::now() + kPatience;
        while (shown_.find(wanted) == std::string::npos) {
            pollfd waiting{screen_, POLLIN, 0};
            char text[4096];
            if (std::chrono::steady_clock::now() > last) return false;
            if (::poll(&waiting, 1, 100) <= 0) continue;
            const ssize_t size = ::read(screen_, text, sizeof text);
            if (size <= 0) return false;  // the other side is closed
            shown_.append(text, static_cast<std::size_t>(size));
        }
        return true;
    }
    void send(const std::string& text) {
        ASSERT_EQ(::write(input_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
        ::close(input_[1]);
    }
    /// The exit code.
    int end() {
        wait_for("what no line holds");
        int status = 0;
        EXPECT_EQ(::waitpid(child_, &status, 0), child_);
        ::close(screen_);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int kill_and_end() {
        ::kill(child_, SIGTERM);
        return end();
    }

    int screen_ = -1;
    int input_[2] = {-1, -1};
    pid_t child_ = -1;
    std::string shown_;
};

TEST_F(ProgressLine, TellsShareRateAndTimeLeftOfRepetitions) {
    put("a.x3d", grid_scene(3));
    start_on_terminal({"a.x3d", "--rep=1000000", "--res=640,480"});
    EXPECT_TRUE(wait_for(" %, ")) << shown_;
    EXPECT_TRUE(wait_for("repetition ")) << shown_;
    EXPECT_TRUE(wait_for(" of 1000000: tracing: ")) << shown_;
    EXPECT_TRUE(wait_for("pixels/s, ")) << shown_;
    EXPECT_TRUE(wait_for(" left")) << shown_;
    EXPECT_EQ(shown_.rfind(kEraseLine, 0), 0U) << shown_;  // one line, written over
    EXPECT_EQ(shown_.find('\n'), std::string::npos) << shown_;
    kill_and_end();
}

TEST_F(ProgressLine, TellsOfTheTileTracerToo) {
    put("a.x3d", grid_scene(3));
    start_on_terminal({"a.x3d", "--rep=1000000", "--res=640,480", "--profile=fast", "--threads=2"});
    EXPECT_TRUE(wait_for(" of 1000000: tracing: ")) << shown_;
    EXPECT_TRUE(wait_for("pixels/s, ")) << shown_;
    kill_and_end();
}

TEST_F(ProgressLine, TellsOfAStudy) {
    put("a.x3d", grid_scene(3));
    start_on_terminal({"a.x3d", "--study", "--rep=10000", "--res=320,240"});
    EXPECT_TRUE(wait_for("picture ")) << shown_;
    EXPECT_TRUE(wait_for(" of 400000: ")) << shown_;
    EXPECT_TRUE(wait_for(" left")) << shown_;
    kill_and_end();
}

// A slow pipe makes reading take as long as one likes.
TEST_F(ProgressLine, BeginsAfterASecondAndIsGoneInTheEnd) {
    start_on_terminal({"-", "--out=a.png", "--res=8,8", "--rep=1"});
    EXPECT_TRUE(wait_for(std::string(kEraseLine) + "reading")) << shown_;
    send(kSmallScene);
    EXPECT_EQ(end(), 0);
    const std::size_t last = shown_.rfind(kEraseLine);
    ASSERT_NE(last, std::string::npos);
    EXPECT_EQ(shown_.substr(last), kEraseLine) << shown_;
    EXPECT_TRUE(exists("a.png"));
    EXPECT_NE(file_text(base_ / "stdout").find("average"), std::string::npos);
}

TEST_F(ProgressLine, StaysAwayFromShortRuns) {
    put("a.x3d", kSmallScene);
    start_on_terminal({"a.x3d", "--res=8,8", "--rep=1"});
    EXPECT_EQ(end(), 0);
    // A machine that is held up for a second shows a line, and erases it.
    if (!shown_.empty()) {
        EXPECT_TRUE(shown_.ends_with(kEraseLine)) << shown_;
    }
}

/// Quiet, bytes on standard output: the terminal stays as it is however long it takes.
TEST_F(ProgressLine, IsSilentWhereItWouldBeInTheWay) {
    for (const char* flag : {"--quiet", "--json=-", "--out=-"}) {
        shown_.clear();
        start_on_terminal({"-", "--res=8,8", "--rep=1",
                           std::string(flag) == "--out=-" ? "--headlight=on" : "--out=a.png",
                           flag});
        ::usleep(1'300'000);
        send(kSmallScene);
        EXPECT_EQ(end(), 0);
        EXPECT_EQ(shown_.find('\033'), std::string::npos) << flag << shown_;
    }
}

TEST_F(ProgressLine, IsNotWrittenToFiles) {
    put("a.x3d", grid_scene(3));
    const pid_t child = start({"a.x3d", "--rep=1000000", "--res=640,480"});
    ::usleep(1'500'000);
    ::kill(child, SIGTERM);
    EXPECT_EQ(finish(child).err, "");
}

}  // namespace
}  // namespace nuvo::cli_test
