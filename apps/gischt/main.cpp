// SPDX-License-Identifier: Apache-2.0
// The command line of gischt: declares the sub-commands, runs one, and turns errors into exit
// statuses.
#include <fcntl.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

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

// The last words, also where nobody can hear them.
int fail(int status, const std::string& words) {
    std::fputs((words + "\n").c_str(), stderr);
    return status;
}

// Where a standard stream was closed, the first file to be written would take its number, and what
// is printed would go into it.
void open_standard_streams() {
    for (const int descriptor : {0, 1, 2}) {
        if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor) _exit(4);
    }
}

int run_guarded(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& e) {
        return fail(exit_status(e.kind()), e.what());
    } catch (const std::bad_alloc&) {
        return fail(4, "gischt: out of memory; lower domain.resolution or the picture's size");
    } catch (const std::length_error&) {
        return fail(4,
                    "gischt: more than memory can hold; lower domain.resolution or the "
                    "picture's size");
    } catch (const std::system_error& e) {  // threads, folders
        return fail(4, fmt::format("gischt: the system refuses: {}", e.what()));
    } catch (const std::exception& e) {
        // What TBB throws, a runtime_error like any other.
        if (std::string_view(e.what()).find("pthread_create") != std::string_view::npos)
            return fail(4, "gischt: no memory is left for threads; try fewer --threads");
        return fail(1, fmt::format("gischt: internal error: {}", e.what()));
    }
}

// Results that did not reach the reader are no results; that he has gone away is his affair.
int close_output(int status) {
    errno = 0;
    if ((std::fflush(stdout) == 0 && !std::ferror(stdout)) || errno == EPIPE) return status;
    return status != 0 ? status : fail(4, "gischt: the standard output cannot be written");
}

}  // namespace
}  // namespace gischt

int main(int argc, char** argv) {
    gischt::open_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on files is a full disk, not an end
    return gischt::close_output(gischt::run_guarded(argc, argv));
}
