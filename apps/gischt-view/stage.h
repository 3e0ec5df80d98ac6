// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fluid/emitter.h"
#include "studio/fluid_frames.h"

namespace gischt {

// What there is to see at one frame of a scene. Cheap to share between threads.
struct Snapshot {
    std::shared_ptr<const LoadedScene> scene;  // what the view refers to
    std::shared_ptr<const World> world;
    View view;            // of the size of the scene's film
    CameraParams camera;  // the scene's own, or the one that was fitted
    int frame = 1;
    double seconds = 0;        // that it took
    std::uint64_t serial = 0;  // rises from snapshot to snapshot
};

// Gives the scene with these overrides KEY=VALUE. Throws what reading it throws.
using SceneLoader = std::function<LoadedScene(const std::vector<std::string>& overrides, Job&)>;

// Simulates and looks up frames in a thread of its own, so that nobody waits for them. Frames that
// were seen are kept up to a limit of memory, so that one can go back to them.
class Stage {
  public:
    // `cache`: a folder with the scene's frames; without one they live in memory.
    Stage(SceneLoader loader, std::optional<std::filesystem::path> cache);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // Another scene. The frames of the old one are forgotten.
    void open(SceneLoader loader);
    // The scene's parameters; frames are kept where the motion does not depend on them. Where the
    // overrides are refused, error() says why and the old scene stays.
    void set_overrides(std::vector<std::string> overrides);
    void seek(int frame);
    // Forward in the scene's speed or as fast as frames can be made; a simulation goes on beyond
    // the last frame, what is read from files begins anew.
    void play(bool on);
    // Forgets all frames and begins at the first.
    void reset();
    // What a hand does to the simulated fluids from now on, in metres of the scene; nothing: it
    // lets go. Frames that come after are different ones.
    void stir(std::optional<EmitterParams> hand);

    // The newest, null in the beginning.
    std::shared_ptr<const Snapshot> latest() const;
    bool is_playing() const;
    bool is_busy() const;        // works on a frame
    std::string error() const;   // of the last thing that failed; empty once something succeeds
    int furthest_frame() const;  // that can be gone to without simulating

  private:
    using Frames = std::vector<std::shared_ptr<const Frame>>;

    void work();
    bool step(std::unique_lock<std::mutex>& lock);
    void load(std::unique_lock<std::mutex>& lock);
    Frames frames(int number);
    void keep(int number, const Frames& frames);
    void publish(int number, const Frames& frames, double start);
    void begin_fluids();

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Wishes, under the mutex.
    SceneLoader loader_;
    std::vector<std::string> overrides_;
    bool must_load_ = true, must_reset_ = false, playing_ = false, ends_ = false, busy_ = true;
    std::optional<int> wanted_;
    std::optional<EmitterParams> hand_;
    std::string error_;
    std::shared_ptr<const Snapshot> latest_;
    int furthest_ = 0;

    // Of the thread alone.
    std::optional<std::filesystem::path> folder_;
    std::shared_ptr<const LoadedScene> scene_, motion_;  // motion_: the one of the frames
    std::shared_ptr<World> world_;
    std::optional<Cache> cache_;
    std::vector<FluidFrames> fluids_;
    std::map<int, Frames> kept_;
    std::map<int, std::size_t> bytes_;
    std::size_t kept_bytes_ = 0;
    std::uint64_t serial_ = 0;
    int shown_ = 0;
    double next_at_ = 0;  // when the next frame is due, s
    Job job_;
    std::thread thread_;
};

}  // namespace gischt
