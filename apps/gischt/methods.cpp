// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "command.h"
#include "render/method.h"

namespace gischt {

// gischt methods
void add_methods(CLI::App& app, CommandContext& context) {
    CLI::App* sub = app.add_subcommand(
        "methods", "The render methods: what each simulates, leaves out, and costs");
    sub->callback([&context] {
        context.action = [] {
            for (const MethodInfo& m : render_methods()) {
                fmt::print("{}\n  simulates   {}\n  leaves out  {}\n  cost        {}\n\n", m.name,
                           m.simulates, m.leaves_out, m.cost);
            }
            return 0;
        };
    });
}

}  // namespace gischt
