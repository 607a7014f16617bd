#include "nuvo/image/file_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <string>
#include <system_error>

namespace nuvo::image {
namespace {

namespace fs = std::filesystem;

// The name a signal handler has to remove: plain bytes, since a handler may not allocate.
char pending_name[PATH_MAX];
volatile std::sig_atomic_t is_pending = 0;

void set_pending(const fs::path& name) {
    const std::string& text = name.native();
    if (text.size() >= sizeof pending_name) return;  // open() will refuse it, too
    is_pending = 0;
    std::memcpy(pending_name, text.c_str(), text.size() + 1);
    is_pending = 1;
}

std::string reason(int error) { return std::generic_category().message(error); }

bool starts_with(const std::string& text, std::string_view start) {
    return text.compare(0, start.size(), start) == 0;
}

// Names of open files are links to what they stand for; renaming over the link would lose it.
bool names_open_file(const fs::path& path) {
    const std::string& name = path.native();
    return name == "/dev/stdout" || name == "/dev/stderr" || starts_with(name, "/dev/fd/") ||
           starts_with(name, "/proc/self/fd/");
}

bool must_be_written_directly(const fs::path& path) {
    if (path == kStandardOutput || names_open_file(path)) return true;
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status);
}

// A link keeps being a link: the file it names is replaced.
fs::path follow_link(const fs::path& path) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    fs::path target = fs::canonical(path, error);
    return error ? path : target;
}

}  // namespace

FileWriter::FileWriter(fs::path path) : path_(std::move(path)), target_(follow_link(path_)) {
    if (must_be_written_directly(path_)) {
        open_directly();
    } else {
        open_temporary();
    }
}

FileWriter::~FileWriter() { discard(); }

void FileWriter::open_directly() {
    descriptor_ = path_ == kStandardOutput ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                           : ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
}

void FileWriter::open_temporary() {
    if (path_.filename().empty()) fail(EISDIR);  // "", "folder/"
    struct stat old {};
    const bool replaces = ::stat(target_.c_str(), &old) == 0;
    if (!replaces && errno != ENOENT) fail(errno);  // a name too long, a file in place of a folder
    if (replaces && ::access(target_.c_str(), W_OK) != 0) fail(errno);
    constexpr int kAttempts = 100;  // names left behind by killed processes of the same number
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        temporary_ = target_.parent_path() / (".nuvo-" + std::to_string(::getpid()) + "-" +
                                              std::to_string(attempt) + ".tmp");
        set_pending(temporary_);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) break;
        is_pending = 0;
        if (errno != EEXIST) break;
    }
    if (descriptor_ < 0) {
        const int error = errno;
        temporary_.clear();
        fail(error);
    }
    if (replaces && ::fchmod(descriptor_, old.st_mode & 07777) != 0) fail(errno);
}

void FileWriter::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            fail(errno);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void FileWriter::commit() {
    // EINVAL, EROFS: a pipe or a device, which has nothing to flush.
    if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP)
        fail(errno);
    const int closed = ::close(descriptor_);
    const int close_error = errno;
    descriptor_ = -1;
    if (closed != 0) fail(close_error);
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    temporary_.clear();
    is_pending = 0;
}

void FileWriter::discard() noexcept {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    temporary_.clear();
    is_pending = 0;
}

void FileWriter::fail(int error) {
    discard();
    const bool is_standard = path_ == kStandardOutput;
    throw WriteError((is_standard ? "standard output" : path_.string()) +
                     ": cannot write: " + reason(error));
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
    FileWriter writer(path);
    writer.write(bytes);
    writer.commit();
}

void check_writable(const fs::path& path) {
    if (!must_be_written_directly(path)) {
        const FileWriter probe(path);  // dropped without a commit
        return;
    }
    if (path == kStandardOutput) return;
    std::error_code ignored;
    // Opening a pipe would wait for its reader, so only the permission is asked for.
    const int error = fs::is_directory(path, ignored)     ? EISDIR
                      : ::access(path.c_str(), W_OK) != 0 ? errno
                                                          : 0;
    if (error != 0) throw WriteError(path.string() + ": cannot write: " + reason(error));
}

void remove_pending_temporary() noexcept {
    if (is_pending != 0) ::unlink(pending_name);
}

}  // namespace nuvo::image
