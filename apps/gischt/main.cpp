// SPDX-License-Identifier: Apache-2.0
// The command line of gischt: declares the sub-commands, runs one, and turns errors into exit
// statuses.
#include <fmt/format.h>
#include <hwy/targets.h>

#include <cstdio>
#include <new>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "command.h"

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

// CLI11 knows the commands; the nearest one is more useful than its list.
void suggest_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
    if (std::ranges::find(names, argv[1]) != names.end()) return;
    throw Error(ErrorKind::Usage, "gischt", fmt::format("unknown command '{}'", argv[1]),
                hint_for(argv[1], names));
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
    CLI::App app("gischt simulates liquids and gases and renders them, from preview to film",
                 "gischt");
    app.set_version_flag(
        "--version",
        fmt::format("gischt {}\nOpenVDB 10, OpenEXR 3, Highway; no window, no GPU", version));
    app.require_subcommand(1);
    add_run(app, context);
    add_sim(app, context);
    add_render(app, context);
    add_check(app, context);
    add_info(app, context);
    add_merge(app, context);
    add_compare(app, context);
    add_scenes(app, context);
    add_doc(app, context);
    add_methods(app, context);

    suggest_command(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) {
        return app.exit(done);  // --help, --version
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::Usage, "gischt", e.what(), "see gischt --help");
    }
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
