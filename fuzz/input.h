// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace gischt {

// Bytes as a file: in memory where the system has /dev/shm, since a fuzzer writes thousands a
// second. One of each extension per process.
class InputFile {
  public:
    InputFile(std::string_view bytes, std::string_view extension);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

// Runs a reader. Errors about the input are right; others end the program.
template <class F>
void expect_read_or_refused(F&& read) {
    try {
        read();
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Internal || e.kind() == ErrorKind::Cancelled) throw;
    }
}

}  // namespace gischt
