#include "nuvo/image/file_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "nuvo/math/signals_blocked.h"

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

/// The temporaries of a target are named after it, so that its next writer finds those of writers
/// that were killed. There are as many as writers of one target at a time.
constexpr int kTemporaries = 32;

fs::path temporary_name(const fs::path& target, int number) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a: as long as the name may be, it fits
    const fs::path file = target.filename();
    for (const char c : file.native())
        hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return target.parent_path() /
           (".nuvo-" + std::to_string(hash) + "-" + std::to_string(number) + ".tmp");
}

bool is_named(int descriptor, const fs::path& name) {
    struct stat open {
    }, named{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// A writer holds a lock on its temporary, and the system lets go of it however the writer ends.
// What can be locked is abandoned.
void remove_abandoned(const fs::path& name) {
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_named(descriptor, name))
        ::unlink(name.c_str());
    ::close(descriptor);
}

/// Creates the file and locks it: its descriptor, or -1 and errno, EEXIST where another writer has
/// the name.
int create_locked(const fs::path& name) {
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    const bool is_locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    // Where files cannot be locked, none is taken for abandoned.
    const bool is_taken = is_locked ? !is_named(descriptor, name) : errno == EWOULDBLOCK;
    if (!is_taken) return descriptor;
    ::close(descriptor);
    errno = EEXIST;
    return -1;
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
    for (int number = 0; number < kTemporaries; ++number)
        remove_abandoned(temporary_name(target_, number));
    for (int number = 0; number < kTemporaries && descriptor_ < 0; ++number) {
        temporary_ = temporary_name(target_, number);
        const SignalsBlocked held;
        descriptor_ = create_locked(temporary_);
        if (descriptor_ >= 0)
            set_pending(temporary_);  // from here on nothing may throw but by fail()
        else if (errno != EEXIST)
            break;
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
    // The lock stays until the temporary has its new name.
    const int lock = temporary_.empty() ? -1 : ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
    const int closed = ::close(std::exchange(descriptor_, lock));
    if (closed != 0) fail(errno);
    if (temporary_.empty()) return;
    const SignalsBlocked held;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    is_pending = 0;
    temporary_.clear();
    discard();
}

void FileWriter::discard() noexcept {
    const SignalsBlocked held;
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
        is_pending = 0;
    }
    temporary_.clear();
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
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
