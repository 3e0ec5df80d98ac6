// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.h"
#include "scene/scene.h"
#include "schema/doc.h"

namespace gischt {

int print_doc(const DocOptions& options) {
    if (options.markdown)
        fmt::print("{}", markdown(scene_table()));
    else if (options.json_schema)
        fmt::print("{}\n", json_schema(scene_table()));
    else
        fmt::print("{}", document(scene_table(), options.address));
    return 0;
}

}  // namespace gischt
