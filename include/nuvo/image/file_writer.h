#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace nuvo::image {

/// A file that cannot be written: what() is one line, "FILE: reason".
class WriteError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// The name that stands for standard output; "./-" is a file of that name.
inline constexpr const char* kStandardOutput = "-";

/// A file that appears whole or not at all. The bytes go to a temporary name in the target's
/// folder; commit() flushes it to the disk and renames it, and a writer that dies before leaves the
/// target as it was; the target's next writer removes what a killed one left (decision 0082). What
/// exists and is no regular file (a device, a pipe) is written directly and never renamed over, and
/// so is standard output. Every failure is a WriteError. One writer at a time.
class FileWriter {
  public:
    /// Opens the temporary, or the target itself where it must be written directly.
    explicit FileWriter(std::filesystem::path path);
    ~FileWriter();
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    void write(std::string_view bytes);
    /// Ends the file; nothing may be written after it.
    void commit();

  private:
    void open_directly();
    void open_temporary();
    void discard() noexcept;
    [[noreturn]] void fail(int error);

    std::filesystem::path path_;       // as the user named it
    std::filesystem::path target_;     // path_ with a final symbolic link followed
    std::filesystem::path temporary_;  // empty: target_ is written directly
    int descriptor_ = -1;
};

/// One whole file by FileWriter.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Throws the WriteError that a FileWriter for `path` would meet on opening (missing folder, no
/// permission, read-only mount, a folder of that name), and leaves nothing behind. A disk that
/// fills up later cannot be foreseen.
void check_writable(const std::filesystem::path& path);

/// Removes the temporary of the writer now open, if any. Safe in a signal handler that ends the
/// process afterwards.
void remove_pending_temporary() noexcept;

}  // namespace nuvo::image
