// SPDX-License-Identifier: Apache-2.0
#include "input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

namespace gischt {

static std::string folder_in_memory() {
    return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm"
                                           : std::filesystem::temp_directory_path().string();
}

InputFile::InputFile(std::string_view bytes, std::string_view extension)
    : path_(fmt::format("{}/gischt_fuzz_{}{}", folder_in_memory(), ::getpid(), extension)) {
    const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const bool whole = file >= 0 && ::write(file, bytes.data(), bytes.size()) ==
                                        static_cast<ssize_t>(bytes.size());
    if (file >= 0) ::close(file);
    if (!whole) throw std::runtime_error("the fuzzer cannot write " + path_);
}

InputFile::~InputFile() {
    ::unlink(path_.c_str());
}

}  // namespace gischt
