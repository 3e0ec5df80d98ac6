// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "image/display.h"
#include "image/image.h"

namespace gischt {

struct Mp4Options {
    double frames_per_second = 24;
    int quality = 16;  // x264's crf: 0 lossless, 16 without visible loss, 23 its default, 51 worst
    DisplayOptions display;
    Metadata metadata;
};

// Writes a movie frame by frame: H.264, 4:2:0, BT.709, by the program ffmpeg at the other end of a
// pipe. The file appears under its name at finish(); without it nothing is left. Frames of odd size
// get their last column or row twice, as 4:2:0 needs even ones.
// Throws Error{Resource} when ffmpeg is missing (the hint says what to install) or fails, with what
// it said; and what AtomicFile throws.
class Mp4Writer {
  public:
    Mp4Writer(const std::string& path, int width, int height, const Mp4Options& options = {});
    ~Mp4Writer();
    Mp4Writer(const Mp4Writer&) = delete;
    Mp4Writer& operator=(const Mp4Writer&) = delete;

    // Throws Error{Usage} when the image has another size.
    void add(const Image& image);
    // Ends the movie and waits for ffmpeg. Throws Error{Usage} when it has no frame.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gischt
