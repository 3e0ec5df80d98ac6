// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.h"

namespace gischt {
namespace {

namespace fs = std::filesystem;

// The file that a chain of symbolic links ends at, which need not exist.
fs::path follow_links(fs::path path) {
    std::error_code ignored;
    for (int hop = 0; hop < 40 && fs::is_symlink(path, ignored); ++hop) {
        path = path.parent_path() / fs::read_symlink(path, ignored);
    }
    return path;
}

constexpr std::string_view temporary_mark = ".gischt-";
std::atomic<unsigned> temporaries_named{0};

// A name that no other process or thread uses: ".stem.gischt-PID-COUNT.ext", the stem cut such that
// the whole stays below the 255 bytes that file systems allow.
fs::path temporary_name(const fs::path& target) {
    const std::string unique =
        fmt::format("gischt-{}-{}", ::getpid(), temporaries_named.fetch_add(1));
    const std::string stem = target.stem().string().substr(0, 150);
    const std::string extension = target.extension().string().substr(0, 50);
    return target.parent_path() / ("." + stem + "." + unique + extension);
}

// Whether a file of that name was made by a process that has ended. A process of the same number as
// ours may have run in another container: a count that we have not come to is not ours.
bool is_of_dead_process(std::string_view name) {
    const std::size_t mark = name.rfind(temporary_mark);
    if (!name.starts_with('.') || mark == name.npos) return false;
    const char *at = name.data() + mark + temporary_mark.size(), *end = name.data() + name.size();
    pid_t process = 0;
    unsigned number = 0;
    const auto dash = std::from_chars(at, end, process);
    if (dash.ec != std::errc() || dash.ptr == end || *dash.ptr != '-' || process <= 0) return false;
    if (std::from_chars(dash.ptr + 1, end, number).ec != std::errc()) return false;
    if (process == ::getpid()) return number >= temporaries_named.load();
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

// Processes of other machines and containers are not seen, but their locks are.
bool is_locked(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    const bool locked = descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) != 0;
    if (descriptor >= 0) ::close(descriptor);
    return locked;
}

// So that the new name survives a loss of power. Some file systems cannot sync a folder: then there
// is nothing better to be done.
void sync_folder(const fs::path& folder) {
    const int descriptor =
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

std::string hint_for_errno(int code) {
    if (code == ENOSPC || code == EDQUOT) return "free some space or choose another folder";
    if (code == EACCES || code == EPERM || code == EROFS) return "choose a folder you may write to";
    return {};
}

void require_replaceable(const std::string& path, const fs::path& target) {
    std::error_code ignored;
    const fs::file_status status = fs::status(target, ignored);
    if (fs::is_directory(status) || target.filename().empty()) {
        throw Error(ErrorKind::Usage, path, "is a folder", "name a file in it");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        throw Error(ErrorKind::Usage, path, "is not a regular file", "name a file");
    }
}

}  // namespace

void AtomicFile::fail(const std::string& doing) const {
    const int code = errno;
    throw Error(ErrorKind::Resource, path_, doing + ": " + std::strerror(code),
                hint_for_errno(code));
}

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
    const fs::path target = follow_links(path);
    require_replaceable(path, target);
    target_ = target.string();
    if (target.has_parent_path()) {
        std::error_code code;
        fs::create_directories(target.parent_path(), code);
        if (code) {
            errno = code.value();
            fail(fmt::format("cannot make the folder '{}'", target.parent_path().string()));
        }
    }
    remove_orphans(target.parent_path());
    do {
        temporary_ = temporary_name(target).string();
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) {
        temporary_.clear();
        fail("cannot write");
    }
    ::flock(descriptor_, LOCK_EX | LOCK_NB);  // shows the others that it is not an orphan
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const char> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("cannot write");
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

void AtomicFile::write(std::span<const unsigned char> bytes) {
    write(std::span(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void AtomicFile::commit() {
    // A library may have replaced the file under the temporary name: sync what is there now.
    ::close(descriptor_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0 || ::fsync(descriptor_) != 0) fail("cannot write");
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail("cannot write");
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot write");
    temporary_.clear();
    sync_folder(fs::path(target_).parent_path());
}

void remove_orphans(const fs::path& folder) {
    std::error_code error;
    fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const fs::path& path = entry->path();
        std::error_code ignored;
        if (!is_of_dead_process(path.filename().native()) || is_locked(path)) continue;
        fs::remove(path, ignored);
    }
}

}  // namespace gischt
