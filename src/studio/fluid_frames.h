// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scene/world.h"
#include "studio/cache.h"
#include "studio/probe_tables.h"
#include "studio/statistics.h"

namespace gischt {

// The frames of one fluid of a scene, in rising order: from the cache where they lie there, else
// computed and, where there is a cache, written to it. What is handed out is what lies on the disk,
// so that a picture does not depend on whether its frame was computed just now.
class FluidFrames {
  public:
    // `cache` may be null; then computed frames live in memory only. Scene and cache must outlive
    // it.
    FluidFrames(const LoadedScene& scene, std::size_t fluid, const Cache* cache);
    // Writes the tables of the scene's probes to a folder from now on; `restart` drops those that
    // are there.
    void probe(const std::filesystem::path& folder, bool restart);

    // Figures of newly computed frames are added to `run`.
    std::shared_ptr<const Frame> get(int number, RunStatistics& run, Job& job);
    // Makes sure that the frame lies in the cache, without reading it.
    void ensure(int number, RunStatistics& run, Job& job);

    // What a hand does to a fluid that lives in memory, in metres of the scene, from the next frame
    // on; the frames that come after are no longer those of the scene alone. False where nothing
    // can be done to it.
    bool stir(const std::vector<EmitterParams>& hand, Job& job);
    // The last frame that was computed, 0 in the beginning; nothing where any frame can be had.
    std::optional<int> last_computed() const;

    // To be called after the last frame: leaves the state from which a longer sequence goes on.
    void finish();

  private:
    bool is_cached(int number) const;
    bool can_give(int number) const;
    bool load_state(Job& job);
    void start(int number, Job& job);
    Frame compute(int number, RunStatistics& run, Job& job);
    void compute_and_write(int number, RunStatistics& run, Job& job);
    void save_state(bool now);
    void report_unmeasured(int number, Job& job);

    const LoadedScene& scene_;
    std::size_t fluid_;
    const Cache* cache_;
    std::string name_;
    std::unique_ptr<FluidSource> source_;
    std::optional<ProbeTables> tables_;
    bool reported_unmeasured_ = false;
    int saved_ = 0;           // the frame of the state on the disk
    double saved_at_ = 0;     // when it was written, seconds
    double saving_took_ = 0;  // seconds
};

}  // namespace gischt
