// SPDX-License-Identifier: Apache-2.0
#include "studio/cache_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.h"

namespace gischt {

// What the holder wrote into the file: its process number, or "" in the moment before.
static std::string holder_of(int descriptor) {
    std::array<char, 32> text{};
    const ssize_t n = ::pread(descriptor, text.data(), text.size(), 0);
    return n > 0 ? std::string(text.data(), static_cast<std::size_t>(n)) : std::string();
}

// Whether the open file is still the one of that name: its holder removes it when it is done.
static bool is_there(int descriptor, const std::filesystem::path& path) {
    struct stat held {
    }, named{};
    return ::fstat(descriptor, &held) == 0 && ::stat(path.c_str(), &named) == 0 &&
           held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

CacheLock::CacheLock(const std::filesystem::path& folder) : path_(folder / ".lock") {
    for (;;) {
        descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor_ < 0) {
            throw Error(ErrorKind::Resource, folder.string(),
                        fmt::format("cannot write: {}", std::strerror(errno)),
                        "choose a folder you may write to");
        }
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            const std::string holder = holder_of(descriptor_);
            ::close(descriptor_);
            descriptor_ = -1;
            throw Error(ErrorKind::Usage, folder.string(),
                        holder.empty() ? "another process writes to this cache"
                                       : fmt::format("process {} writes to this cache", holder),
                        "wait for it, or give another folder");
        }
        if (is_there(descriptor_, path_)) break;
        ::close(descriptor_);
    }
    // A full disk leaves the number out, which only the message of another process would tell.
    const std::string number = std::to_string(::getpid());
    if (::ftruncate(descriptor_, 0) == 0)
        (void)!::pwrite(descriptor_, number.data(), number.size(), 0);
}

CacheLock& CacheLock::operator=(CacheLock&& other) noexcept {
    release();
    std::swap(descriptor_, other.descriptor_);
    std::swap(path_, other.path_);
    return *this;
}

void CacheLock::release() noexcept {
    if (descriptor_ < 0) return;
    ::unlink(path_.c_str());  // while it is ours
    ::close(descriptor_);
    descriptor_ = -1;
}

}  // namespace gischt
