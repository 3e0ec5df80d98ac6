// SPDX-License-Identifier: Apache-2.0
#include "studio/film_keeper.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"

namespace gischt {

bool is_same_picture(const Metadata& a, const Metadata& b, std::string& differing_key) {
    for (const char* key :
         {"version", "scene", "picture_hash", "frame", "view", "method", "seed", "preview"}) {
        if (a.get(key) == b.get(key)) continue;
        differing_key = key;
        return false;
    }
    return true;
}

FilmKeeper::FilmKeeper(std::vector<std::string> paths, Metadata metadata, bool restart)
    : paths_(std::move(paths)), metadata_(std::move(metadata)) {
    std::error_code ignored;
    if (paths_.empty() || restart || !std::filesystem::exists(paths_[0], ignored)) return;
    FilmFile file = read_film(paths_[0]);
    std::string key;
    if (!is_same_picture(file.metadata, metadata_, key)) {
        throw Error(ErrorKind::Usage, paths_[0],
                    fmt::format("belongs to another picture: its {} is '{}', not '{}'", key,
                                file.metadata.get(key), metadata_.get(key)),
                    "--restart throws it away, or choose another name");
    }
    state_ = std::move(file.state);
}

void FilmKeeper::attach(RenderSettings& settings) {
    if (paths_.empty()) return;
    settings.film = &state_;
    settings.on_checkpoint = [this] { save(); };
}

void FilmKeeper::save() {
    if (!state_.film) return;
    for (const std::string& path : paths_) write_film(path, state_, metadata_);
}

void FilmKeeper::finish(const std::string& method) {
    if (paths_.empty()) return;
    if (!state_.film) {
        throw Error(ErrorKind::Usage, paths_[0],
                    fmt::format("the method '{}' takes no samples that a film could keep", method),
                    "write a .exr or .png");
    }
    save();
}

}  // namespace gischt
