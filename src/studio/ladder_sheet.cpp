// SPDX-License-Identifier: Apache-2.0
// The files of a ladder: pictures, differences, the labelled sheet and the table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "image/color.h"
#include "image/colormap.h"
#include "image/draw.h"
#include "image/resize.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "studio/ladder.h"

namespace gischt {
namespace fs = std::filesystem;
namespace {

constexpr int thumb_width = 320, margin = 8, columns = 4;  // pixels
constexpr int label_height = 3 * 10;
const Vec3f ink(0.85f), paper(0.012f);

// "march-depth-2"
std::string file_name(const LadderRung& rung) {
    std::string name;
    for (const char c : rung.label) {
        if (c == ',') continue;
        name += c == ' ' ? '-' : c;
    }
    return name;
}

// As the scene shows it, with values to be shown by the tone curve `linear`.
Image shown(const Scene& scene, const Image& image) {
    const DisplayImage codes = to_display(image, display_of(scene, image), 16);
    Image out = Image::rgb(image.width, image.height);
    const auto planes = out.color();
    for (std::size_t i = 0; i < out.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto channels = static_cast<std::size_t>(codes.channels);
            planes[c][i] = srgb_decode(static_cast<float>(codes.codes[channels * i + c]) / 65535);
        }
    }
    return out;
}

struct Tile {
    Image picture, difference;  // display-linear
    std::string text;
};

std::string short_time(double seconds) {
    return seconds < 10 ? fmt::format("{:.2f} s", seconds) : fmt::format("{:.0f} s", seconds);
}

// Pictures in rows, each with its difference below.
Image sheet_of(const std::vector<Tile>& tiles) {
    const int height = tiles[0].picture.height;
    const int cell_width = thumb_width + margin, cell_height = label_height + 2 * (height + margin);
    const int count = static_cast<int>(tiles.size());
    const int across = std::min(columns, count), rows = (count + across - 1) / across;
    Image sheet = Image::rgb(across * cell_width + margin, rows * cell_height + margin);
    fill_rectangle(sheet, {0, 0}, {sheet.width, sheet.height}, paper);
    for (int i = 0; i < count; ++i) {
        const Tile& tile = tiles[static_cast<std::size_t>(i)];
        const int x = margin + i % across * cell_width, y = margin + i / across * cell_height;
        draw_text(sheet, {x, y + 2}, tile.text, ink);
        paste(sheet, tile.picture, x, y + label_height);
        if (tile.difference.width > 0)
            paste(sheet, tile.difference, x, y + label_height + height + margin / 2);
    }
    return sheet;
}

Image thumb(const Image& image) {
    const int height = std::max(1, image.height * thumb_width / image.width);
    return resize(image, thumb_width, height);
}

// What a method leaves out, at a depth.
std::string left_out(const LadderRung& rung) {
    if (rung.method == "march" && rung.depth > 1) {
        return fmt::format("light scattered more than {} times; glass, metal, lights with a size",
                           rung.depth);
    }
    return std::string(find_method(rung.method).leaves_out);
}

std::string table_of(const LoadedScene& scene, const Ladder& ladder) {
    std::string out = fmt::format(
        "# One scene by every method\n\n"
        "Written by `gischt ladder {}`. All methods solve the same equation for the same scene in "
        "the same unit, as far as each goes; so their pictures can be subtracted. The reference "
        "is: {}.\n\n![All pictures with their differences](ladder.png)\n\n"
        "Below each picture its difference from the reference, in units of that one's mean: blue "
        "is too dark, red too bright. RMSE and the ratio of the means are over all pixels and "
        "channels; relative: root of the mean of (A - B)^2 / (B^2 + 0.01 mean(B)^2). Wall seconds "
        "are those of this machine, CPU seconds the sum over its threads.\n\n"
        "| method | samples | wall s | CPU s | RMSE | relative | ratio of means | left out |\n"
        "|---|---|---|---|---|---|---|---|\n",
        scene.name, ladder.reference_label);
    std::string refused;
    for (const LadderStep& s : ladder.steps) {
        if (!s.refusal.empty()) {
            refused += fmt::format("- `{}`: {}\n", s.rung.label, s.refusal);
            continue;
        }
        out += fmt::format("| {} | {:.4g} | {:.2f} | {:.2f} | {:.3g} | {:.3g} | {:.4f} | {} |\n",
                           s.rung.label, s.statistics.samples_per_pixel, s.wall_seconds,
                           s.cpu_seconds, s.difference.rmse, std::sqrt(s.difference.rel_mse),
                           s.difference.ratio, left_out(s.rung));
    }
    if (!refused.empty()) out += "\nNot for this scene:\n\n" + refused;
    return out;
}

}  // namespace

Image difference_image(const Image& a, const Image& b) {
    const auto x = a.color(), y = b.color();
    const auto luminance_at = [](const auto& planes, std::size_t i) {
        return static_cast<double>(luminance(Vec3f(planes[0][i], planes[1][i], planes[2][i])));
    };
    double mean = 0;
    for (std::size_t i = 0; i < b.pixel_count(); ++i) mean += luminance_at(y, i);
    mean /= static_cast<double>(b.pixel_count());
    Image out = Image::rgb(a.width, a.height);
    const auto planes = out.color();
    for (std::size_t i = 0; i < out.pixel_count(); ++i) {
        const double off = (luminance_at(x, i) - luminance_at(y, i)) / (mean > 0 ? mean : 1);
        const Vec3f color = colormap(ColormapKind::Coolwarm, static_cast<float>(0.5 + 0.5 * off));
        for (std::size_t c = 0; c < 3; ++c) planes[c][i] = color[static_cast<int>(c)];
    }
    out.metadata.set("display_referred", "true");
    return out;
}

std::vector<std::string> write_ladder(const LoadedScene& scene, const LadderOrder& order,
                                      const Ladder& ladder, RunStatistics& run) {
    std::vector<std::string> written;
    const auto write = [&](const std::string& name, const Image& image) {
        const std::string path = (order.folder / name).string();
        WriteOptions options;
        options.display = display_of(scene.scene, image);
        write_image(path, image, options);
        written.push_back(path);
    };
    fs::create_directories(order.folder);
    write("reference.exr", ladder.reference);
    write("reference.png", ladder.reference);
    std::vector<Tile> tiles;
    for (const LadderStep& s : ladder.steps) {
        if (!s.refusal.empty()) continue;
        const std::string name = file_name(s.rung);
        const Image difference = difference_image(s.image, ladder.reference);
        write(name + ".exr", s.image);
        write(name + ".png", s.image);
        write(name + "-difference.png", difference);
        tiles.push_back(
            {thumb(shown(scene.scene, s.image)), thumb(difference),
             fmt::format("{}\n{}  RMSE {:.3g}\nratio of means {:.4f}", s.rung.label,
                         short_time(s.wall_seconds), s.difference.rmse, s.difference.ratio)});
        run.images.push_back({written.back(), s.rung.method, order.frames.first, s.image.width,
                              s.image.height, s.statistics});
    }
    tiles.push_back(
        {thumb(shown(scene.scene, ladder.reference)), {}, "reference:\n" + ladder.reference_label});
    Image sheet = sheet_of(tiles);
    sheet.metadata.set("display_referred", "true");
    write("ladder.png", sheet);
    const fs::path table = order.folder / "ladder.md";
    AtomicFile file(table.string());
    const std::string text = table_of(scene, ladder);
    file.write(std::span<const char>(text));
    file.commit();
    written.push_back(table.string());
    return written;
}

}  // namespace gischt
