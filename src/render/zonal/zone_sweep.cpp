// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zone_sweep.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/units.h"
#include "math/fast_math.h"

namespace gischt {

ChordLength chord_length(float extinction, float chord) {
    const float x = extinction * chord;
    // Below, the closed form cancels.
    if (x < 0.02f) {
        return {chord * (1 - x * (0.5f - x * (1.0f / 6))),
                chord * chord * (0.5f - x * (1.0f / 6 - x * (1.0f / 24)))};
    }
    const float l = (1 - fast_exp(-x)) / extinction;
    return {l, (chord - l) / extinction};
}

namespace {

struct Chord {
    Vec3f l, m;
};

Chord chord_of(const ZoneGrid& grid, const ZoneCrossing& crossing) {
    const Vec3f& e = grid.extinction[crossing.zone];
    const ChordLength x = chord_length(e.x, crossing.length);
    if (grid.is_grey) return {Vec3f(x.l), Vec3f(x.m)};
    const ChordLength y = chord_length(e.y, crossing.length),
                      z = chord_length(e.z, crossing.length);
    return {{x.l, y.l, z.l}, {x.m, y.m, z.m}};
}

// Sums the results of tasks in pairs, always the same ones.
void add_up(std::vector<std::vector<Vec3f>>& parts) {
    for (std::size_t stride = 1; stride < parts.size(); stride *= 2) {
        for (std::size_t i = 0; i + stride < parts.size(); i += 2 * stride) {
            const auto n = static_cast<int>(parts[i].size());
            parallel_ranges(n, 4096, [&](int begin, int end) {
                for (auto e = static_cast<std::size_t>(begin); e < static_cast<std::size_t>(end);
                     ++e) {
                    parts[i][e] += parts[i + stride][e];
                }
            });
        }
    }
}

}  // namespace

ZoneSweep::ZoneSweep(const Enclosure& enclosure, Job& job) : enclosure_(enclosure), job_(job) {
    std::vector<std::vector<Vec3f>> parts(line_tasks);
    parallel_for(line_tasks, 1, [&](int task) {
        job.check();
        std::vector<Vec3f>& sum = parts[static_cast<std::size_t>(task)];
        sum.resize(enclosure.elements());
        LineTracer tracer(enclosure);
        const std::size_t first = enclosure.first_patch();
        for_lines(enclosure, side_range(enclosure, task), tracer,
                  [&](const LineTracer& line, const StartingLine& start) {
                      for (const LinePiece& p : line.pieces) {
                          for (std::size_t i = p.first; i < p.last; ++i) {
                              const ZoneCrossing& c = line.crossings[i];
                              sum[c.zone].x += 2 * start.weight * c.length;
                          }
                          for (const int patch : {p.from_patch, p.to_patch}) {
                              if (patch < 0) continue;
                              sum[first + static_cast<std::size_t>(patch)].x += start.weight;
                          }
                      }
                  });
    });
    add_up(parts);
    for (const Vec3f& v : parts[0]) measure_.push_back(v.x);
}

double ZoneSweep::measure_error() const {
    const Vec3d h = enclosure_.grid.cell_size();
    const double truth = 4 * pi * h.x * h.y * h.z;
    double most = 0;
    for (std::size_t i = 0; i < enclosure_.grid.size(); ++i) {
        most = std::max(most, std::abs(static_cast<double>(measure_[i]) / truth - 1));
    }
    return most;
}

std::vector<Vec3f> ZoneSweep::mean_radiance(const ArrivingLight& light) const {
    std::vector<Vec3f> mean(light.at.size());
    for (std::size_t i = 0; i < mean.size(); ++i) {
        if (measure_[i] > 0) mean[i] = light.at[i] / Vec3f(measure_[i]);
    }
    return mean;
}

void ZoneSweep::sweep_task(int task, std::span<const Vec3f> source, bool with_incoming,
                           ArrivingLight& out) const {
    out.at.resize(enclosure_.elements());
    out.leaving.resize(enclosure_.side_cells());
    const std::size_t patches = enclosure_.first_patch();
    const auto start_value = [&](int patch, int cell) {
        if (patch >= 0) return source[patches + static_cast<std::size_t>(patch)];
        if (cell < 0 || !with_incoming) return Vec3f{};
        const int side = side_of(enclosure_, static_cast<std::size_t>(cell));
        return enclosure_.incoming[static_cast<std::size_t>(side)];
    };
    const auto end_at = [&](int patch, int cell, const Vec3f& power) {
        if (patch >= 0) {
            out.at[patches + static_cast<std::size_t>(patch)] += power;
        } else if (cell >= 0) {
            out.leaving[static_cast<std::size_t>(cell)] += power;
        }
    };
    std::vector<Chord> chords;
    const ZoneGrid& grid = enclosure_.grid;
    const auto cross = [&](const ZoneCrossing& c, const Chord& chord, float weight, Vec3f& light) {
        const Vec3f q = source[c.zone];
        out.at[c.zone] += weight * (light * chord.l + q * chord.m);
        light = light - light * grid.extinction[c.zone] * chord.l + q * chord.l;
    };
    LineTracer tracer(enclosure_);
    for_lines(enclosure_, side_range(enclosure_, task), tracer,
              [&](const LineTracer& line, const StartingLine& start) {
                  for (const LinePiece& p : line.pieces) {
                      chords.clear();
                      Vec3f light = start_value(p.from_patch, p.from_cell);
                      for (std::size_t i = p.first; i < p.last; ++i) {
                          chords.push_back(chord_of(grid, line.crossings[i]));
                          cross(line.crossings[i], chords.back(), start.weight, light);
                      }
                      end_at(p.to_patch, p.to_cell, start.weight * light);
                      light = start_value(p.to_patch, p.to_cell);
                      for (std::size_t i = p.last; i-- > p.first;) {
                          cross(line.crossings[i], chords[i - p.first], start.weight, light);
                      }
                      end_at(p.from_patch, p.from_cell, start.weight * light);
                  }
              });
}

ArrivingLight ZoneSweep::operator()(std::span<const Vec3f> source, bool with_incoming) const {
    std::vector<ArrivingLight> tasks(line_tasks);
    parallel_for(line_tasks, 1, [&](int task) {
        job_.check();
        sweep_task(task, source, with_incoming, tasks[static_cast<std::size_t>(task)]);
    });
    std::vector<std::vector<Vec3f>> at, leaving;
    for (ArrivingLight& t : tasks) {
        at.push_back(std::move(t.at));
        leaving.push_back(std::move(t.leaving));
    }
    add_up(at);
    add_up(leaving);
    return {std::move(at[0]), std::move(leaving[0])};
}

}  // namespace gischt
