// SPDX-License-Identifier: Apache-2.0
#include "render/diffusion/diffusion_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/zonal/first_light.h"
#include "render/zonal/zone_sweep.h"

namespace gischt {
namespace {

// Lines along the cells in all three ways find what stands in the box.
void refuse_surfaces_inside(const View& view, const ZoneGrid& grid) {
    if (view.surfaces.is_empty()) return;
    for (int a = 0; a < 3; ++a) {
        const int u = (a + 1) % 3, v = (a + 2) % 3;
        const Vec3d h = grid.cell_size();
        Ray ray;
        ray.direction = {};
        ray.direction[a] = 1;
        ray.t_max = grid.box.size()[a];
        for (int j = 0; j < grid.cells[v]; ++j) {
            for (int i = 0; i < grid.cells[u]; ++i) {
                ray.origin[a] = grid.box.lo[a];
                ray.origin[u] = grid.box.lo[u] + (i + 0.5) * h[u];
                ray.origin[v] = grid.box.lo[v] + (j + 0.5) * h[v];
                const auto hit = view.surfaces.intersect(ray);
                if (!hit) continue;
                throw Error(ErrorKind::Usage, "diffusion",
                            fmt::format("solid '{}' stands in the box of the media",
                                        view.surfaces.info(hit->surface).name),
                            "take method 'zonal' or 'path'");
            }
        }
    }
}

// The box with cubic cells, its middle where it was.
ZoneGrid cubic_zones(const View& view, const Box3d& media, int along, ZoneScattering scattering,
                     Job& job) {
    const double h = max_component(media.size()) / along;
    Vec3i cells;
    Box3d box;
    for (int a = 0; a < 3; ++a) {
        cells[a] = std::max(2, static_cast<int>(std::ceil(media.size()[a] / h - 1e-6)));
        const double middle = 0.5 * (media.lo[a] + media.hi[a]);
        box.lo[a] = middle - 0.5 * cells[a] * h;
        box.hi[a] = middle + 0.5 * cells[a] * h;
    }
    constexpr int points = 3;  // per edge of a cell
    return make_zones(view.media, box, cells, points, scattering, job);
}

// What glows, seen unscattered: mean radiance by cell.
std::vector<Vec3f> seen_glow(const ZoneGrid& grid, Job& job) {
    Enclosure enclosure;
    enclosure.grid = grid;
    enclosure.lines = 8;
    const ZoneSweep sweep(enclosure, job);
    return sweep.mean_radiance(sweep(grid.emission, false));
}

class Diffused : public ScatteredSource {
  public:
    Diffused(ZoneGrid grid, DiffuseLight light)
        : grid_(std::move(grid)), light_(std::move(light)) {}

    ScatteredLight in_medium(const Vec3d& point, const Vec3d& forward,
                             const Medium& medium) const override {
        const auto g = static_cast<float>(mean_cosine(medium.phase()));
        Vec3f light = grid_.interpolate(light_.fluence, point);
        for (int a = 0; a < 3 && g != 0; ++a) {
            light -= static_cast<float>(3 * forward[a]) * g *
                     grid_.interpolate_signed(light_.flux[static_cast<std::size_t>(a)], point);
        }
        return {{}, {}, static_cast<float>(0.25 / pi) * max(light, Vec3f(0))};
    }
    ScatteredLight on_surface(const SurfaceHit&) const override { return {}; }

  private:
    ZoneGrid grid_;
    DiffuseLight light_;
};

}  // namespace

DiffusionProblem diffusion_problem(const View& view, const Box3d& media,
                                   const DiffusionParams& params, Job& job) {
    DiffusionProblem problem;
    problem.grid = cubic_zones(view, media, params.resolution, ZoneScattering::Plain, job);
    const ZoneGrid reduced =
        cubic_zones(view, media, params.resolution, ZoneScattering::Reduced, job);
    problem.transport_extinction = reduced.extinction;
    const std::size_t n = problem.grid.size();
    problem.power.resize(n);
    for (auto& m : problem.moment) m.resize(n);
    const std::vector<Vec3f> glow =
        problem.grid.emission.empty() ? std::vector<Vec3f>(n) : seen_glow(problem.grid, job);
    const FirstLight lights(view, problem.grid, params.light_samples);
    parallel_for(static_cast<int>(n), 64, [&](int cell) {
        const auto i = static_cast<std::size_t>(cell);
        if (cell % 64 == 0) job.check();
        const Vec3f& scattering = problem.grid.scattering[i];
        if (!(max_component(scattering) > 0)) return;
        problem.power[i] = scattering * static_cast<float>(4 * pi) * glow[i];
        const Vec3f turned = scattering - reduced.scattering[i];  // g s
        lights.for_zone(i, [&](const Vec3d& direction, const Vec3f& weight) {
            problem.power[i] += scattering * weight;
            for (int a = 0; a < 3; ++a) {
                problem.moment[static_cast<std::size_t>(a)][i] -=
                    static_cast<float>(direction[a]) * turned * weight;
            }
        });
    });
    return problem;
}

std::unique_ptr<ScatteredSource> light_by_diffusion(const View& view, const Box3d& media,
                                                    const DiffusionParams& params, Job& job) {
    const PhaseTimer timer(job, "light");
    DiffusionProblem problem = diffusion_problem(view, media, params, job);
    refuse_surfaces_inside(view, problem.grid);
    float most = 0;
    for (const Vec3f& e : problem.transport_extinction) most = std::max(most, max_component(e));
    const double across = static_cast<double>(most) * max_component(media.size());
    if (across < 2) {
        job.warn(
            fmt::format("diffusion: the media are at most {:.2g} free paths across; light does "
                        "not diffuse in so little, 'zonal' and 'path' know better",
                        across));
    }
    job.info(fmt::format("diffusion: {} x {} x {} cells", problem.grid.cells.x,
                         problem.grid.cells.y, problem.grid.cells.z));
    DiffuseLight light = diffuse_light(problem, params.tolerance, job);
    return std::make_unique<Diffused>(std::move(problem.grid), std::move(light));
}

}  // namespace gischt
