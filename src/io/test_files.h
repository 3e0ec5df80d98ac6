// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "image/image.h"

namespace gischt {

// A folder of a test's own, removed with what is in it.
class TestFolder {
  public:
    explicit TestFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("gischt_" + name + "_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }
    // Entries in it, hidden ones too.
    int count() const {
        int n = 0;
        for ([[maybe_unused]] const auto& e : std::filesystem::directory_iterator(path_)) ++n;
        return n;
    }

  private:
    std::filesystem::path path_;
};

inline void put(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// The kind of gischt::Error that `call` throws; fails the comparison with any other outcome.
enum class Outcome { Fine, Usage, Input, Resource, Other };
template <class F>
Outcome outcome(F&& call) {
    try {
        call();
        return Outcome::Fine;
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Usage) return Outcome::Usage;
        if (e.kind() == ErrorKind::Input) return Outcome::Input;
        if (e.kind() == ErrorKind::Resource) return Outcome::Resource;
    } catch (...) {
    }
    return Outcome::Other;
}

// Random values in [0, largest) in R, G, B, A, Z and one layer.
inline Image random_image(int width, int height, float largest = 1, std::uint64_t seed = 1) {
    Image image = Image::rgba(width, height);
    image.add_channel("Z");
    image.add_channel("direct.R");
    for (std::size_t c = 0; c < image.planes.size(); ++c) {
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            const std::uint64_t key = random_key(seed, c, i);
            image.planes[c].values[i] = largest * random_uniform(key, 0);
        }
    }
    return image;
}

// Calls check(path) for files that `bytes` becomes by cutting at many lengths, by flipping bytes,
// and for random bytes after the same first eight. check(path, must_fail).
template <class F>
void for_broken_files(const std::string& path, const std::string& bytes, F&& check) {
    for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 97) {
        put(path, bytes.substr(0, n));
        check(path, true);
    }
    for (std::uint32_t k = 0; k < 400; ++k) {
        std::string broken = bytes;
        for (std::uint32_t f = 0; f < 1 + k % 4; ++f) {
            // Two thirds of the damage in the header, where it can do most harm.
            const std::size_t range =
                f % 3 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
            broken[random_bits(random_key(7, k, f), 0) % range] =
                static_cast<char>(random_bits(random_key(7, k, f), 1));
        }
        put(path, broken);
        check(path, false);
    }
    for (std::uint32_t k = 0; k < 50; ++k) {
        std::string noise = bytes.substr(0, k % 2 ? 8 : 0);
        for (std::uint32_t i = 0; i < 700; ++i) {
            noise += static_cast<char>(random_bits(random_key(8, k, i), 0));
        }
        put(path, noise);
        check(path, true);
    }
}

// What every reader must refuse as Error{Input}: nothing, emptiness, a folder.
template <class F>
bool refuses_what_is_no_file(const TestFolder& folder, F&& read) {
    put(folder.file("empty"), "");
    return outcome([&] { read(folder.file("missing")); }) == Outcome::Input &&
           outcome([&] { read(folder.file("empty")); }) == Outcome::Input &&
           outcome([&] { read(folder.file(".")); }) == Outcome::Input;
}

}  // namespace gischt
