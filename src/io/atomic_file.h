// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace gischt {

// A file that appears under its name complete or not at all. The bytes go into a temporary file in
// the same folder, which commit() syncs to the disk and renames; a file that was there before is
// replaced in one step. Without commit() the temporary file is removed. Use:
//   AtomicFile file(path);
//   file.write(bytes);            // or let a library write to file.temporary()
//   file.commit();
// A process that is killed leaves its temporary file behind; the next AtomicFile in that folder
// removes it. All members throw Error{Resource} with the path and the system's reason when the disk
// is full, the folder cannot be made or written, and Error{Usage} when `path` is a folder or a
// device.
class AtomicFile {
  public:
    // Makes the folder where it is missing, and the temporary file; its name keeps the extension. A
    // symbolic link is followed, so that what it points at is replaced.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return path_; }
    const std::string& temporary() const { return temporary_; }

    void write(std::span<const char> bytes);
    void write(std::span<const unsigned char> bytes);
    void commit();

  private:
    [[noreturn]] void fail(const std::string& doing) const;

    std::string path_;       // as given, for messages
    std::string target_;     // after symbolic links
    std::string temporary_;  // empty once it has been renamed
    int descriptor_ = -1;
};

// Removes the temporary files that killed processes left in a folder: those whose name tells a
// process that no longer runs, and which nobody has locked. Never throws; what cannot be removed
// stays.
void remove_orphans(const std::filesystem::path& folder);

}  // namespace gischt
