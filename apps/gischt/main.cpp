// SPDX-License-Identifier: Apache-2.0
// The command line of gischt: declares the sub-commands, runs one, and turns errors into exit
// statuses.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <cstdio>
#include <new>

#include "base/error.h"
#include "base/parallel.h"
#include "commands.h"

namespace gischt {
namespace {

int exit_status(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Usage:
            return 2;
        case ErrorKind::Input:
            return 3;
        case ErrorKind::Resource:
            return 4;
        case ErrorKind::Cancelled:
            return 130;
        case ErrorKind::Internal:
            break;
    }
    return 1;
}

std::string join_arguments(int argc, char** argv) {
    std::string line = "gischt";
    for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
    return line;
}

// Holds the run-time dispatch to an instruction set, so that results can be compared between
// machines.
void pin_simd(const std::string& name) {
    if (name == "baseline") hwy::DisableTargets(HWY_AVX2 | HWY_AVX3);
    if (name == "avx2") hwy::DisableTargets(HWY_AVX3);
    if (name == "avx512" && !(hwy::SupportedTargets() & HWY_AVX3)) {
        throw Error(ErrorKind::Usage, "--simd", "this processor has no AVX-512",
                    "leave the flag out");
    }
}

int run(int argc, char** argv) {
    CommandContext context;
    context.command_line = join_arguments(argc, argv);
    if (const auto status = parse(argc, argv, context)) return *status;
    pin_simd(context.simd);
    const ThreadLimit threads(context.threads);
    return context.action();
}

}  // namespace
}  // namespace gischt

int main(int argc, char** argv) {
    try {
        return gischt::run(argc, argv);
    } catch (const gischt::Error& e) {
        fmt::print(stderr, "{}\n", e.what());
        return gischt::exit_status(e.kind());
    } catch (const std::bad_alloc&) {
        fmt::print(stderr,
                   "gischt: out of memory; lower domain.resolution or the picture's size\n");
        return 4;
    } catch (const std::exception& e) {
        fmt::print(stderr, "gischt: internal error: {}\n", e.what());
        return 1;
    }
}
