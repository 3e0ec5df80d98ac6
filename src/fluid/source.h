// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/job.h"
#include "fluid/emitter.h"
#include "fluid/ledger.h"
#include "fluid/probes/probe_params.h"
#include "fluid/solid.h"
#include "grid/frame.h"

namespace gischt {

// What a scene says about the world around a fluid.
struct FluidWorld {
    Vec3d gravity{0, 0, -9.80665};    // m/s^2
    double fps = 24;                  // frames per second
    std::vector<SolidParams> solids;  // in metres of the fluid's own space
};

// What happened between two frames; one line of --stats.
struct FrameStatistics {
    int frame = 0;
    double time = 0;  // s
    int steps = 0;
    int pressure_iterations = 0;       // of all steps
    double pressure_residual = 0;      // largest of the steps: max|r| / max|b|
    double max_divergence_dt = 0;      // largest of the steps: |div u| dt
    double mass = 0;                   // kg: reference density times the integral of density
    double kinetic_energy = 0;         // J
    double kinetic_energy_change = 0;  // J, since the frame before
    double max_speed = 0;              // m/s, largest component
    ScalarLedger density_ledger;       // m^3, of this frame
    ScalarLedger heat_ledger;          // K m^3
    double mass_per_volume = 0;        // kg/m^3: makes the density's ledger one of mass
    std::int64_t cells = 0;
    int active_tiles = 0;  // with density or temperature
    double wall_seconds = 0;
};

// Where frames come from. Frame n shows the time n / fps: frame 0 is the state in the beginning,
// and frame 1 the first that is written by custom.
class FluidSource {
  public:
    virtual ~FluidSource() = default;

    // The frame of that number. A stateless source gives any; a simulation computes all frames up
    // to it, and throws Error{Usage} when it lies before the last one. After Error{Cancelled} a
    // simulation has stopped within a step: it goes on from a loaded state only.
    virtual Frame frame(int number, Job& job) = 0;
    // Of the frame given last.
    virtual FrameStatistics statistics() const = 0;
    // True for a simulation: frames must come in order.
    virtual bool is_sequential() const = 0;

    // Sources beside those of the scene, from the next step on, in place of those of the last call:
    // what a hand does to the fluid. False where nothing can be done to it.
    virtual bool set_hand(const std::vector<EmitterParams>&) { return false; }

    // Measures these from now on, the present state among it where no frame was computed yet. False
    // where nothing can be measured. Throws Error{Usage} for places that the fluid does not reach.
    virtual bool set_probes(const std::vector<ProbeParams>&) { return false; }
    // What was measured since the last call: per probe its rows (see fluid/probes/probe.h).
    virtual std::vector<std::vector<std::vector<double>>> take_probe_rows() { return {}; }

    // Everything that a later frame depends on, in one file that is whole when save_state()
    // returns (who must not lose the file before gives it an AtomicFile); the resumed run gives the
    // same bits as the uninterrupted one. Nothing for stateless sources. load_state() throws
    // Error{Input} for a file that is damaged or of another domain; the source is then unchanged.
    virtual void save_state(const std::filesystem::path& path) const = 0;
    virtual void load_state(const std::filesystem::path& path) = 0;
    // Number of the last frame computed or loaded; 0 in the beginning.
    virtual int last_frame() const = 0;

    // The box that the fluid can fill, m.
    virtual Box3d bounds() const = 0;
};

}  // namespace gischt
