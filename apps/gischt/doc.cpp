// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "scene/scene.h"
#include "schema/doc.h"

namespace gischt {

// gischt doc [COMPONENT[.KEY]]
void add_doc(CLI::App& app, CommandContext& context) {
    struct Options {
        std::string address;
        bool markdown = false, json_schema = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* sub = app.add_subcommand("doc", "The manual of every parameter");
    sub->add_option("COMPONENT", options->address,
                    "A component (medium), a key (medium.g) or a path (fluid.medium.g)");
    sub->add_flag("--markdown", options->markdown, "The whole manual as Markdown");
    sub->add_flag("--json-schema", options->json_schema,
                  "A JSON schema of scene files, for editors");
    sub->callback([options, &context] {
        context.action = [options] {
            if (options->markdown)
                fmt::print("{}", markdown(scene_table()));
            else if (options->json_schema)
                fmt::print("{}\n", json_schema(scene_table()));
            else
                fmt::print("{}", document(scene_table(), options->address));
            return 0;
        };
    });
}

}  // namespace gischt
