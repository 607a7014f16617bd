#include "nuvo/image/file_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace nuvo::image {
namespace {

namespace fs = std::filesystem;

class FileWriterTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = testing::TempDir() + "/nuvo-writer-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string content(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    std::ptrdiff_t entries() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }

    fs::path folder_;
};

std::string error_of(const fs::path& path, const std::string& bytes = "x") {
    try {
        write_file_atomically(path, bytes);
    } catch (const WriteError& error) {
        return error.what();
    }
    return {};
}

TEST_F(FileWriterTest, WritesAndReplacesWithNothingElseLeftBehind) {
    write_file_atomically(folder_ / "a", "first");
    EXPECT_EQ(content("a"), "first");
    write_file_atomically(folder_ / "a", std::string("se\0cond", 7));
    EXPECT_EQ(content("a"), std::string("se\0cond", 7));
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, TheTargetIsUntouchedUntilCommit) {
    put("a", "old");
    {
        FileWriter writer(folder_ / "a");
        writer.write("new");
        EXPECT_EQ(content("a"), "old");
        EXPECT_EQ(entries(), 2);
    }
    EXPECT_EQ(content("a"), "old");
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, TheSignalHandlersHelperRemovesTheTemporary) {
    FileWriter writer(folder_ / "a");
    writer.write("half");
    EXPECT_EQ(entries(), 1);
    remove_pending_temporary();
    EXPECT_EQ(entries(), 0);
}

TEST_F(FileWriterTest, NothingIsRemovedOnceTheFileIsComplete) {
    write_file_atomically(folder_ / "a", "whole");
    remove_pending_temporary();
    EXPECT_EQ(content("a"), "whole");
}

TEST_F(FileWriterTest, WhatAKilledWriterLeftIsRemovedByTheNextOfItsTarget) {
    put("a", "old");
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        FileWriter writer(folder_ / "a");
        writer.write("half");
        ::kill(::getpid(), SIGKILL);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    EXPECT_EQ(content("a"), "old");
    EXPECT_EQ(entries(), 2);
    check_writable(folder_ / "other");
    EXPECT_EQ(entries(), 2);  // each target's own
    write_file_atomically(folder_ / "a", "new");
    EXPECT_EQ(content("a"), "new");
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, AWriterAtWorkKeepsItsTemporaryBesideOthersOfItsTarget) {
    FileWriter first(folder_ / "a");
    first.write("fir");
    write_file_atomically(folder_ / "a", "second");
    EXPECT_EQ(content("a"), "second");
    EXPECT_EQ(entries(), 2);
    first.write("st");
    first.commit();
    EXPECT_EQ(content("a"), "first");
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, AForeignLinkUnderTheTemporarysNameIsNotFollowed) {
    put("precious", "mine");
    fs::path name;
    {
        const FileWriter writer(folder_ / "a");
        for (const auto& entry : fs::directory_iterator(folder_))
            if (entry.path().extension() == ".tmp") name = entry.path();
    }
    fs::create_symlink("precious", name);
    write_file_atomically(folder_ / "a", "new");
    EXPECT_EQ(content("a"), "new");
    EXPECT_EQ(content("precious"), "mine");
    EXPECT_FALSE(fs::is_symlink(folder_ / "a"));
}

TEST_F(FileWriterTest, AMissingFolderIsNamed) {
    const fs::path path = folder_ / "none" / "a";
    EXPECT_NE(error_of(path).find(path.string() + ": "), std::string::npos);
    EXPECT_THROW(check_writable(path), WriteError);
    EXPECT_EQ(entries(), 0);
}

TEST_F(FileWriterTest, AFolderIsNoTarget) {
    EXPECT_FALSE(error_of(folder_).empty());
    EXPECT_THROW(check_writable(folder_), WriteError);
    EXPECT_THROW(check_writable(folder_ / ""), WriteError);
}

TEST_F(FileWriterTest, AFolderThatTakesNoFilesIsFoundByTheCheck) {
    // Nobody creates these, whatever the permission bits and the user say.
    put("file", "no folder");
    for (const fs::path& path : {folder_ / "file" / "a.bmp", folder_ / std::string(300, 'a')}) {
        EXPECT_THROW(check_writable(path), WriteError);
        EXPECT_FALSE(error_of(path).empty());
    }
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, TheCheckLeavesNoTraceAndChangesNothing) {
    put("old", "old");
    check_writable(folder_ / "old");
    check_writable(folder_ / "new");
    EXPECT_EQ(content("old"), "old");
    EXPECT_EQ(entries(), 1);
}

TEST_F(FileWriterTest, AFullDeviceIsAnError) {
    check_writable("/dev/full");  // cannot be known in advance
    EXPECT_NE(error_of("/dev/full").find("/dev/full: "), std::string::npos);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(FileWriterTest, ADeviceIsWrittenDirectlyAndStays) {
    EXPECT_EQ(error_of("/dev/null"), "");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(FileWriterTest, ALinkKeepsBeingALink) {
    put("real", "old");
    fs::create_symlink("real", folder_ / "link");
    write_file_atomically(folder_ / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(content("real"), "new");
}

TEST_F(FileWriterTest, AReplacedFileKeepsItsPermissions) {
    put("a", "old");
    ::chmod((folder_ / "a").c_str(), 0640);
    write_file_atomically(folder_ / "a", "new");
    EXPECT_EQ(fs::status(folder_ / "a").permissions(), fs::perms(0640));
}

TEST_F(FileWriterTest, AFileThatGrowsTooLargeLeavesTheOldOne) {
    put("a", "old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 4096;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string error = error_of(folder_ / "a", std::string(10'000, 'x'));
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_FALSE(error.empty());
    EXPECT_EQ(content("a"), "old");
    EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace nuvo::image
