// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "render/realtime/drawer.h"
#include "stage.h"

namespace gischt {

// A picture that is wished for.
struct PictureWish {
    std::shared_ptr<const Snapshot> shot;
    CameraParams camera;
    Vec2i size{640, 360};  // pixels
    std::string method = "slices";
    int samples = 1;  // per pixel
};

struct Picture {
    Image image;
    std::string method;
    Camera camera;
    int frame = 0;
    double seconds = 0;        // that it took up to now
    double samples = 0;        // per pixel
    bool is_whole = false;     // nothing more will come
    std::uint64_t wish = 0;    // the number of the wish that it answers
    std::uint64_t number = 0;  // rises from picture to picture
};

// Whether a method has a drawer for graphics hardware.
bool is_realtime(const std::string& method);

// Makes pictures in a thread of its own, always the one wished for last: a new wish stops what was
// begun, except that a method of graphics hardware ends its picture. Methods that refine their
// picture show it while it grows.
class Artist {
  public:
    Artist();
    ~Artist();
    Artist(const Artist&) = delete;
    Artist& operator=(const Artist&) = delete;

    // The number of the wish.
    std::uint64_t wish(PictureWish wish);
    // Stops what is being made.
    void rest();
    // The newest picture that has not been taken yet.
    std::shared_ptr<const Picture> take();
    // Why the wish of that number came to nothing; empty while it has not.
    std::string error(std::uint64_t wish) const;

  private:
    void work();
    void make(const PictureWish& wish, std::uint64_t id, Job& job);
    void draw(const PictureWish& wish, std::uint64_t id, Job& job);
    void render(const PictureWish& wish, std::uint64_t id, Job& job);
    void show(Picture picture);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<PictureWish> wished_;
    std::uint64_t wishes_ = 0, pictures_ = 0;
    std::shared_ptr<Job> job_;
    std::shared_ptr<const Picture> newest_;
    std::string error_;
    std::uint64_t failed_ = 0;
    bool ends_ = false;

    // Of the thread alone: the drawer at work and what it was given.
    struct Board;
    std::unique_ptr<Board> board_;
    std::thread thread_;
};

}  // namespace gischt
