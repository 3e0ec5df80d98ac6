// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/lit_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "image/color.h"
#include "optics/local_lights.h"
#include "optics/material.h"
#include "render/march/sky_directions.h"

namespace gischt {
namespace {

// A disc wider than this casts shadows too soft for one direction: 6.5 degrees.
constexpr float least_narrow_pdf = 100;  // 1/sr

void refuse(std::string_view method, const std::string& what, const char* hint) {
    throw Error(ErrorKind::Usage, std::string(method), what, hint);
}

void check_surfaces(const SurfaceSet& surfaces, std::string_view method) {
    for (int i = 0; i < surfaces.size(); ++i) {
        const SurfaceInfo& info = surfaces.info(i);
        if (info.is_lamp) {
            refuse(method, fmt::format("light '{}' has a size", info.name), "take method 'path'");
        }
        if (info.material != MaterialKind::Lambert || info.holdout || info.shadow_catcher) {
            refuse(method,
                   fmt::format("solid '{}' scatters light in another way than Lambert's, or is a "
                               "holdout or shadow catcher",
                               info.name),
                   "take method 'path'");
        }
    }
}

// Nothing for light that comes from all of the sky.
std::optional<GridLight> as_grid_light(const LightPtr& light, std::string_view method) {
    GridLight g;
    g.light = light;
    g.is_infinite = light->is_infinite();
    if (!g.is_infinite) {
        const auto place = light->place();
        if (!place || !light->is_delta()) {
            refuse(method, "light '" + light->name + "' is neither a point nor at infinity",
                   "take method 'path'");
        }
        g.place = place->center;
        return g;
    }
    const LightSample s = light->sample({}, {0, 0});
    const bool is_small_disc = dynamic_cast<const SunLight*>(light.get()) != nullptr;
    if (!light->is_delta() && !(is_small_disc && s.pdf > least_narrow_pdf)) return std::nullopt;
    g.place = is_small_disc ? static_cast<const SunLight&>(*light).direction() : s.direction;
    g.color = s.weight;
    return g;
}

// Trilinear, the values being those of the centres of cells; beyond these that of the nearest.
template <class T>
T interpolated(const std::vector<T>& values, const Vec3i& n, const Box3d& box, const Vec3d& p) {
    const Vec3d q = (p - box.lo) / box.size() * Vec3d(n) - Vec3d(0.5);
    T sum{};
    Vec3i lo;
    Vec3d f;
    for (int a = 0; a < 3; ++a) {
        const double x = std::clamp(q[a], 0.0, n[a] - 1.0);
        lo[a] = std::min(static_cast<int>(x), std::max(n[a] - 2, 0));
        f[a] = x - lo[a];
    }
    for (int c = 0; c < 8; ++c) {
        const Vec3i at = min(lo + Vec3i(c & 1, c >> 1 & 1, c >> 2), n - Vec3i(1));
        const double w =
            (c & 1 ? f.x : 1 - f.x) * (c & 2 ? f.y : 1 - f.y) * (c & 4 ? f.z : 1 - f.z);
        const std::size_t i = static_cast<std::size_t>(at.x) +
                              static_cast<std::size_t>(n.x) *
                                  (static_cast<std::size_t>(at.y) +
                                   static_cast<std::size_t>(n.y) * static_cast<std::size_t>(at.z));
        sum += static_cast<float>(w) * values[i];
    }
    return sum;
}

// Where light that comes from a point's `towards` enters the box last: the point itself, if inside.
std::optional<Vec3d> last_in_box(const Box3d& box, const Vec3d& point, const Vec3d& towards,
                                 double distance) {
    const Interval in = clip({point, towards, 0, distance}, box);
    if (in.is_empty()) return std::nullopt;
    return point + in.t0 * towards;
}

}  // namespace

LitGrid::LitGrid(const View& view, const GridParams& params, std::string_view method, Job& job)
    : view_media_(view.media), view_lights_(view.lights), surfaces_(view.surfaces) {
    check_surfaces(view.surfaces, method);
    for (const LightPtr& light : view.lights) {
        if (auto g = as_grid_light(light, method)) {
            lights.push_back(std::move(*g));
        } else {
            broad.push_back(light.get());
        }
    }
    for (const auto& medium : view.media) {
        if (!medium->has_lattice()) {
            refuse(method, "a medium has no end, or is as large as a planet",
                   "give the fog a box, or take method 'path'");
        }
    }
    {
        const PhaseTimer timer(job, "bake");
        lay(view, params.resolution, job);
    }
    const PhaseTimer timer(job, "light");
    for (GridLight& light : lights) light_cells(light, view, params.light, job);
    if (!is_empty() && params.sky_directions > 0) light_sky(view, params.sky_directions, job);
}

bool LitGrid::holds_for(const View& view) const {
    // Copies of a set of surfaces share what they hold, the list of lights among it.
    const bool is_same_surfaces =
        surfaces_.is_empty()
            ? view.surfaces.is_empty()
            : !view.surfaces.is_empty() && &surfaces_.lights() == &view.surfaces.lights();
    return view_media_ == view.media && view_lights_ == view.lights && is_same_surfaces;
}

// The grid of one medium that stands straight is that of its voxels, or every n-th of them; of
// others it is any with cubic cells.
void LitGrid::lay(const View& view, int resolution, Job& job) {
    Box3d box = Box3d::empty();
    for (const auto& medium : view.media) {
        if (!medium->bounds().is_empty()) box.extend(medium->bounds());
    }
    if (box.is_empty()) return;
    const Medium::Lattice lattice = view.media.front()->lattice();
    const auto& c = lattice.to_world.column;
    const bool is_straight = c[0].x > 0 && c[1].y > 0 && c[2].z > 0 && c[0].y == 0 && c[0].z == 0 &&
                             c[1].x == 0 && c[1].z == 0 && c[2].x == 0 && c[2].y == 0;
    Vec3i cells;
    int points = 2;
    const Vec3d lo(floor(lattice.box.lo)), hi(Vec3i(0) - floor(-1.0 * lattice.box.hi));
    const Vec3d voxels = hi - lo + Vec3d(1);
    if (view.media.size() == 1 && view.media.front()->cell_size() > 0 && is_straight &&
        max_component(voxels) <= resolution) {
        cells = Vec3i(voxels);
        box = lattice.to_world.bounds({lo - Vec3d(0.5), hi + Vec3d(0.5)});
        points = 1;
    } else {
        const double h = max_component(box.size()) / resolution;
        cells = max(Vec3i(1), Vec3i(0) - floor(-1.0 / h * box.size() + Vec3d(1e-6)));
        const Vec3d center = 0.5 * (box.lo + box.hi), half = 0.5 * h * Vec3d(cells);
        box = {center - half, center + half};
    }
    matter = bake_matter(view.media, box, cells, points, job);
    for (const auto& medium : view.media) {
        const Vec3f e = medium->cross_sections().extinction();
        media.push_back({e, medium->cross_sections().scattering, octaves_of(*medium)});
        is_grey_ = is_grey_ && e.x == e.y && e.x == e.z;
    }
}

std::vector<float> LitGrid::extinction(int channel) const {
    std::vector<float> sum(volume(matter.cells));
    for (std::size_t m = 0; m < media.size(); ++m) {
        const float e = media[m].extinction[channel];
        const std::vector<float>& density = matter.media[m].density;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += e * density[i];
    }
    return sum;
}

void LitGrid::light_cells(GridLight& light, const View& view, LightGridMethod method,
                          Job& job) const {
    if (is_empty()) return;
    const LightOrigin origin{light.is_infinite, light.place};
    for (int c = 0; c < (is_grey_ ? 1 : 3); ++c) {
        const ExtinctionGrid grid{matter.box, matter.cells, extinction(c)};
        light.depth.push_back(depths_to_centers(grid, origin, method, job));
    }
    const bool is_blockable = !view.surfaces.is_empty();
    if (light.is_infinite && !is_blockable) return;

    const ExtinctionGrid at{matter.box, matter.cells, {}};
    const Vec3i n = matter.cells;
    light.arrival.assign(volume(n), 0);
    std::vector<Vec3f> weight(light.is_infinite ? 0 : volume(n));
    parallel_for(n.y * n.z, 4, [&](int row) {
        job.check();
        Vec3i c(0, row % n.y, row / n.y);
        for (; c.x < n.x; ++c.x) {
            const std::size_t i = at.index(c);
            bool is_dense = false;
            for (const auto& m : matter.media) is_dense = is_dense || m.density[i] > 0;
            if (!is_dense) continue;
            const Vec3d p = at.center(c);
            Ray ray{p, light.place};
            float arrives = 1;
            if (!light.is_infinite) {
                const LightSample s = light.light->sample(p, {0, 0});
                ray = {p, s.direction, 0, s.distance};
                weight[i] = s.weight;
                arrives = max_component(s.weight);
            }
            const bool is_blocked = arrives > 0 && is_blockable && view.surfaces.is_blocked(ray);
            light.arrival[i] = is_blocked ? 0 : arrives;
        }
    });
    // A local light has one colour; its strength is in the arrival.
    for (const Vec3f& w : weight) {
        if (max_component(w) > 0) {
            light.color = w / Vec3f(max_component(w));
            break;
        }
    }
}

// The cells that have density or touch such: a look-up beside a dense cell reads those around it.
static std::vector<char> touched_cells(const ExtinctionGrid& grid) {
    std::vector<char> is_touched(grid.extinction.size());
    const Vec3i n = grid.cells;
    parallel_for(n.z, 1, [&](int k) {
        Vec3i c(0, 0, k);
        for (c.y = 0; c.y < n.y; ++c.y) {
            for (c.x = 0; c.x < n.x; ++c.x) {
                const Vec3i lo = max(c - Vec3i(1), Vec3i(0)), hi = min(c + Vec3i(2), n);
                Vec3i d = lo;
                bool is_dense = false;
                for (d.z = lo.z; d.z < hi.z; ++d.z) {
                    for (d.y = lo.y; d.y < hi.y; ++d.y) {
                        for (d.x = lo.x; d.x < hi.x; ++d.x) {
                            is_dense = is_dense || grid.extinction[grid.index(d)] > 0;
                        }
                    }
                }
                is_touched[grid.index(c)] = is_dense;
            }
        }
    });
    return is_touched;
}

// Sweeps light from parts of the sky over a grid of half the resolution.
void LitGrid::light_sky(const View& view, int directions, Job& job) {
    if (broad.empty()) return;
    sky.emplace();
    sky->cells = max(Vec3i(1), Vec3i(0.5 * Vec3d(matter.cells + Vec3i(1))));
    const std::size_t n = volume(sky->cells);
    sky->radiance.assign(media.size(), std::vector<Vec3f>(n));
    std::vector<double> seen(n);
    double all = 0;
    const ExtinctionGrid coarse = bake(view.media, matter.box, sky->cells, 2, job);
    const std::vector<char> is_touched = touched_cells(coarse);
    for (const SkyDirection& d : sky_directions(broad, IsotropicPhase{}, {}, directions)) {
        if (max_component(d.radiance) <= 0) continue;
        const std::vector<float> depth =
            depths_to_centers(coarse, {true, d.direction}, LightGridMethod::Sweep, job);
        const double share = static_cast<double>(d.solid_angle) / (4 * pi);
        const double light = share * luminance(d.radiance);
        all += light;
        parallel_for(sky->cells.z, 1, [&](int k) {
            Vec3i c(0, 0, k);
            for (c.y = 0; c.y < sky->cells.y; ++c.y) {
                for (c.x = 0; c.x < sky->cells.x; ++c.x) {
                    const std::size_t i = coarse.index(c);
                    seen[i] += light * std::exp(-static_cast<double>(depth[i]));
                    if (!is_touched[i] ||
                        view.surfaces.is_blocked({coarse.center(c), d.direction})) {
                        continue;
                    }
                    for (std::size_t m = 0; m < media.size(); ++m) {
                        float sum = 0;
                        for (const Octave& o : media[m].octaves) {
                            sum += o.contribution * std::exp(-o.attenuation * depth[i]);
                        }
                        sky->radiance[m][i] += static_cast<float>(share) * sum * d.radiance;
                    }
                }
            }
        });
    }
    sky->seen.assign(n, 1);
    for (std::size_t i = 0; i < n && all > 0; ++i) {
        sky->seen[i] = static_cast<float>(seen[i] / all);
    }
}

Vec3f LitGrid::transmittance(const GridLight& light, const Vec3d& point,
                             const Vec3d& towards) const {
    if (is_empty()) return Vec3f(1);
    const double distance =
        light.is_infinite ? std::numeric_limits<double>::infinity() : length(light.place - point);
    const auto in = last_in_box(matter.box, point, towards, distance);
    if (!in) return Vec3f(1);
    Vec3f depth;
    for (int c = 0; c < 3; ++c) {
        const std::size_t channel = light.depth.size() == 3 ? static_cast<std::size_t>(c) : 0;
        if (c > 0 && channel == 0) {
            depth[c] = depth[0];
        } else {
            depth[c] = interpolated(light.depth[channel], matter.cells, matter.box, *in);
        }
    }
    return exp(-depth);
}

float LitGrid::sky_seen(const Vec3d& point) const {
    if (!sky || !matter.box.contains(point)) return 1;
    return interpolated(sky->seen, sky->cells, matter.box, point);
}

}  // namespace gischt
