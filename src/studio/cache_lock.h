// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace gischt {

// That only one process at a time writes to a folder: a lock of the operating system (flock) on the
// hidden file `.lock` in it, which holds the number of the process. The system gives the lock back
// when a process ends, however it ends, so that nobody need remove what a killed one left. Where
// the file system knows no locks there is none.
class CacheLock {
  public:
    CacheLock() = default;
    // Throws Error{Usage} at once when another process holds it, and names that; Error{Resource}
    // where the folder cannot be written.
    explicit CacheLock(const std::filesystem::path& folder);
    ~CacheLock() { release(); }
    CacheLock(CacheLock&& other) noexcept { *this = std::move(other); }
    CacheLock& operator=(CacheLock&& other) noexcept;

    bool is_held() const { return descriptor_ >= 0; }

  private:
    void release() noexcept;

    int descriptor_ = -1;
    std::filesystem::path path_;
};

}  // namespace gischt
