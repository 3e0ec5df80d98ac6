// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.h"
#include "render/method.h"

namespace gischt {

int print_methods() {
    for (const MethodInfo& m : render_methods()) {
        fmt::print("{}\n  simulates   {}\n  leaves out  {}\n  cost        {}\n\n", m.name,
                   m.simulates, m.leaves_out, m.cost);
    }
    return 0;
}

}  // namespace gischt
