// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/error.h"
#include "commands.h"
#include "console.h"
#include "image/denoise.h"
#include "io/image_file.h"
#include "studio/film_keeper.h"

namespace gischt {
namespace {

FilmFile sum_of(const std::vector<std::string>& paths, Job& job) {
    FilmFile sum = read_film(paths[0]);
    for (std::size_t i = 1; i < paths.size(); ++i) {
        job.check();
        const FilmFile part = read_film(paths[i]);
        std::string key;
        if (!is_same_picture(sum.metadata, part.metadata, key)) {
            throw Error(ErrorKind::Input, paths[i],
                        fmt::format("is of another picture than {}: its {} is '{}', not '{}'",
                                    paths[0], key, part.metadata.get(key), sum.metadata.get(key)));
        }
        try {
            sum.state.merge(part.state);
        } catch (const Error& e) {
            throw Error(e.kind(), paths[i], e.fact(), e.hint());
        }
    }
    return sum;
}

void write_merged(const std::string& path, const FilmFile& film, Job& job) {
    if (is_film_file(path)) return write_film(path, film.state, film.metadata);
    Image image = film.state.image();
    const Film& f = *film.state.film;
    image.metadata = film.metadata;
    image.metadata.set("samples", fmt::format("{}", static_cast<double>(f.total_samples()) /
                                                        static_cast<double>(image.pixel_count())));
    if (film.metadata.get("denoise") == "true") denoise(image, job);
    WriteOptions options;
    if (const std::string tone = film.metadata.get("tone"); !tone.empty())
        options.display.tone = tone_kind(tone);
    if (const std::string stops = film.metadata.get("exposure"); !stops.empty())
        options.display.exposure = std::strtod(stops.c_str(), nullptr);
    write_image(path, image, options);
}

}  // namespace

int merge_films(const MergeOptions& options, CommandContext& context) {
    const Console console(context);
    for (const std::string& path : options.outputs) {
        if (is_film_file(path) || is_image_file(path)) continue;
        std::vector<std::string> formats = image_extensions();
        formats.push_back(".film");
        throw Error(ErrorKind::Usage, path, "has no extension that tells a format",
                    hint_for(path.substr(std::min(path.rfind('.'), path.size())), formats));
    }
    FilmFile sum = sum_of(options.films, context.job);
    sum.metadata.set("command", context.command_line);
    for (const std::string& path : options.outputs) {
        context.job.check();
        write_merged(path, sum, context.job);
        fmt::print("{}\n", path);
    }
    return 0;
}

}  // namespace gischt
