// SPDX-License-Identifier: Apache-2.0
// replay READER FOLDER...: feeds a reader with the kept inputs, with any compiler and without a
// fuzzer. Fails when one takes more than a second of processor time or the memory grows beyond
// 4 GiB of addresses; a crash speaks for itself.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <vector>

#include "io/file_bytes.h"
#include "readers.h"

// Sanitizers take more addresses than there is memory. GCC defines the first two, clang has
// features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_bound = false;
#elif defined(__has_feature)
constexpr bool has_bound = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool has_bound = true;
#endif

namespace gischt {
namespace {
namespace fs = std::filesystem;

const std::map<std::string, void (*)(std::string_view)> readers{
    {"vdb", fuzz_vdb},   {"exr", fuzz_exr},     {"hdr", fuzz_hdr},
    {"png", fuzz_png},   {"obj", fuzz_obj},     {"ply", fuzz_ply},
    {"film", fuzz_film}, {"state", fuzz_state}, {"scene", fuzz_scene}};

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && entry.file_size() > 0) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

int replay(const std::string& name, const std::vector<fs::path>& files) {
    const auto reader = readers.at(name);
    int slow = 0;
    for (const fs::path& file : files) {
        // Before, so that a crash is seen to be of this file.
        fmt::print("{}\n", file.string());
        std::fflush(stdout);
        const std::string bytes = read_bytes(file.string());
        const double begin = processor_seconds();
        reader(bytes);
        const double seconds = processor_seconds() - begin;
        if (seconds > 1) fmt::print("  takes {:.1f} s\n", seconds);
        slow += seconds > 1;
    }
    fmt::print("{}: {} inputs, {} of them too slow\n", name, files.size(), slow);
    return slow > 0 || files.empty();
}

}  // namespace
}  // namespace gischt

int main(int argc, char** argv) {
    if (argc < 3 || !gischt::readers.contains(argv[1])) {
        fmt::print(stderr, "usage: replay READER FOLDER...\n");
        return 2;
    }
    if (has_bound) {
        const rlimit bound{rlim_t{4} << 30, rlim_t{4} << 30};
        setrlimit(RLIMIT_AS, &bound);
    }
    std::vector<std::filesystem::path> files;
    for (int i = 2; i < argc; ++i) {
        for (auto& file : gischt::files_in(argv[i])) files.push_back(std::move(file));
    }
    return gischt::replay(argv[1], files);
}
