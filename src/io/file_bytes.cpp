// SPDX-License-Identifier: Apache-2.0
#include "io/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>

#include "base/error.h"

namespace gischt {

std::string read_bytes(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        throw Error(ErrorKind::Input, path, "is a folder, not a file");
    }
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) throw Error(ErrorKind::Input, path, std::strerror(errno ? errno : ENOENT));

    std::string bytes;
    // A pipe has no size. A byte more shows the end without another piece.
    const auto size = std::filesystem::file_size(path, ignored);
    const std::size_t chunk =
        ignored ? std::size_t{1} << 20 : std::clamp<std::size_t>(size + 1, 4096, 1 << 20);
    try {
        while (in) {
            const std::size_t had = bytes.size();
            bytes.resize(had + chunk);
            in.read(bytes.data() + had, static_cast<std::streamsize>(chunk));
            bytes.resize(had + static_cast<std::size_t>(in.gcount()));
        }
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, path, "does not fit into memory");
    }
    if (in.bad()) throw Error(ErrorKind::Input, path, "cannot be read");
    if (bytes.empty()) throw Error(ErrorKind::Input, path, "is empty");
    return bytes;
}

}  // namespace gischt
