// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fluid/probes/probe_params.h"
#include "fluid/smoke.h"

namespace gischt {

// One row of a probe's table: the time in seconds, then the probe's values; NaN for what is not
// there (a front without smoke).
using ProbeRow = std::vector<double>;

// Names of the columns with their units, "time [s]" first.
std::vector<std::string> probe_columns(const ProbeParams& probe, bool is_2d);

// The rows of one moment, which are as many at every moment: one, or one per point, height or cell
// on the side. Cost: a sweep over the state at most.
std::vector<ProbeRow> measure_probe(const ProbeParams& probe, const SmokeSolver& solver);

// Computes anew what is no mean of itself in a row of means: the top-hat values of a plume from its
// fluxes.
void complete_mean(const ProbeParams& probe, bool is_2d, ProbeRow& row);

// Throws Error{Usage, "probe 'name'"} for places outside of the domain, sides that a domain in 2-D
// has not, and a plume without a vertical axis.
void check_probe(const ProbeParams& probe, const DomainParams& domain, const Vec3d& gravity);

// Probes of a running simulation: the rows since they were last taken.
class Probes {
  public:
    Probes() = default;
    // Throws as check_probe(), and for solids that the solver's world has not.
    Probes(std::vector<ProbeParams> probes, const SmokeSolver& solver);

    bool is_empty() const { return probes_.empty(); }
    // Measures at the state now, as far as a probe wants it then.
    void note(const SmokeSolver& solver, bool ends_frame);
    // One list of rows per probe, in order of time; leaves none.
    std::vector<std::vector<ProbeRow>> take();

  private:
    std::vector<ProbeParams> probes_;
    std::vector<std::vector<ProbeRow>> rows_;
};

}  // namespace gischt
