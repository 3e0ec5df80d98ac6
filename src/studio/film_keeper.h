// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "io/film_file.h"
#include "render/method.h"

namespace gischt {

// What makes two films parts of the same picture, and what a picture says of itself: pairs of key
// and text, of which the film's own file keeps all.
// Identity are version, scene, picture_hash, frame, view (of a turntable), method, seed, preview.
bool is_same_picture(const Metadata& a, const Metadata& b, std::string& differing_key);

// The `.film` files of one picture: loads the one to go on with, saves now and then and at the end.
class FilmKeeper {
  public:
    // With `restart` what is there is ignored, and replaced by the first save. Throws Error{Usage}
    // when it belongs to another picture, and what read_film throws. No paths: nothing is kept.
    FilmKeeper(std::vector<std::string> paths, Metadata metadata, bool restart);

    // Lets the method work on the film.
    void attach(RenderSettings& settings);
    // Writes the files; nothing when there is no film yet.
    void save();
    // Throws Error{Usage} when the method has kept no film.
    void finish(const std::string& method);

    const std::vector<std::string>& paths() const { return paths_; }

  private:
    std::vector<std::string> paths_;
    Metadata metadata_;
    FilmState state_;
};

}  // namespace gischt
