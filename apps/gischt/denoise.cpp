// SPDX-License-Identifier: Apache-2.0
#include "image/denoise.h"

#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "io/image_file.h"

namespace gischt {

int denoise_image(const DenoiseOptions& options, CommandContext& context) {
    const Console console(context);
    Image image = read_image(options.from);
    denoise(image, context.job);
    image.metadata.set("command", context.command_line);
    WriteOptions write;
    write.display.exposure = options.exposure;
    write_image(options.to, image, write);
    fmt::print("{}\n", options.to);
    return 0;
}

}  // namespace gischt
