// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/zone_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/zonal/first_light.h"
#include "render/zonal/ordinates.h"
#include "render/zonal/zone_solver.h"

namespace gischt {

PatchInterpolation::PatchInterpolation(const Enclosure& enclosure) : enclosure_(enclosure) {}

Vec3f PatchInterpolation::operator()(const SurfaceHit& hit, std::span<const Vec3f> values) const {
    const ZoneGrid& grid = enclosure_.grid;
    if (values.empty() || clip({hit.point, {0, 0, 1}, -1e-9, 1e-9}, grid.box).is_empty()) return {};
    const Vec3d h = grid.cell_size();
    const Vec3i middle = grid.cell_at(hit.point);
    Vec3f sum;
    double weights = 0;
    SurfaceHit at = hit;
    for (int o = 0; o < 125; ++o) {
        const Vec3i c = middle + Vec3i(o % 5 - 2, o / 5 % 5 - 2, o / 25 - 2);
        if (min_component(c) < 0 || min_component(grid.cells - c) < 1) continue;
        at.point = grid.box.lo + (Vec3d(c) + Vec3d(0.5)) * h;
        for (int way = 0; way < 6; ++way) {
            if (hit.normal[way / 2] * (way % 2 != 0 ? 1 : -1) < -0.3) continue;
            at.normal = {};
            at.normal[way / 2] = way % 2 != 0 ? 1 : -1;
            const auto found = enclosure_.patch_of_key.find(enclosure_.patch_key(at));
            if (found == enclosure_.patch_of_key.end()) continue;
            const auto i = static_cast<std::size_t>(found->second);
            const SurfacePatch& p = enclosure_.patches[i];
            double weight = std::max(dot(p.normal, hit.normal), 0.0) * p.hits;
            for (int a = 0; a < 3; ++a) {
                const double off = (p.center[a] - hit.point[a]) / (2 * h[a]);
                const double near = std::max(1 - off * off, 0.0);
                weight *= near * near;
            }
            sum += static_cast<float>(weight) * values[i];
            weights += weight;
        }
    }
    return weights > 0 ? sum / Vec3f(static_cast<float>(weights)) : Vec3f{};
}

namespace {

// Even scattering, with the similarity relation.
class EvenZones : public ScatteredSource {
  public:
    EvenZones(std::unique_ptr<const Enclosure> enclosure, std::vector<Vec3f> reduced,
              std::vector<Vec3f> first)
        : enclosure_(std::move(enclosure)),
          on_patches_(*enclosure_),
          reduced_(std::move(reduced)),
          first_(std::move(first)) {}

    ScatteredLight in_medium(const Vec3d& point, const Vec3d&, const Medium&) const override {
        const std::size_t n = enclosure_->grid.size();
        return {enclosure_->grid.interpolate({reduced_.data(), n}, point),
                enclosure_->grid.interpolate({first_.data(), n}, point),
                {}};
    }
    ScatteredLight on_surface(const SurfaceHit& hit) const override {
        const std::size_t n = enclosure_->grid.size(), patches = enclosure_->patches.size();
        return {on_patches_(hit, {reduced_.data() + n, patches}),
                on_patches_(hit, {first_.data() + n, patches}),
                {}};
    }

  private:
    std::unique_ptr<const Enclosure> enclosure_;
    PatchInterpolation on_patches_;
    std::vector<Vec3f> reduced_, first_;  // by element
};

// Radiance along ordinates. What zones scatter towards the camera is kept by zone; beside the
// camera it is summed anew, as there the directions to it differ within a zone.
class OrdinateZones : public ScatteredSource {
  public:
    OrdinateZones(std::unique_ptr<const Enclosure> enclosure, OrdinateSet set,
                  OrdinateSolution solution, const Camera& camera, PhaseFunction phase)
        : enclosure_(std::move(enclosure)),
          on_patches_(*enclosure_),
          set_(std::move(set)),
          solution_(std::move(solution)),
          camera_(camera),
          phase_(phase) {
        const ZoneGrid& grid = enclosure_->grid;
        towards_.resize(grid.size());
        parallel_for(static_cast<int>(grid.size()), 64, [&](int i) {
            const auto z = static_cast<std::size_t>(i);
            const Vec3d center =
                grid.box.lo + (Vec3d(grid.cell(z)) + Vec3d(0.5)) * grid.cell_size();
            const bool is_flat = camera.projection() == Projection::Orthographic;
            towards_[z] =
                scattered(z, is_flat ? camera.forward() : normalize(center - camera.position()));
        });
    }

    ScatteredLight in_medium(const Vec3d& point, const Vec3d& forward,
                             const Medium&) const override {
        const ZoneGrid& grid = enclosure_->grid;
        const bool is_flat = camera_.projection() == Projection::Orthographic;
        if (is_flat || length(point - camera_.position()) > 3 * max_component(grid.cell_size())) {
            return {{}, {}, grid.interpolate(towards_, point)};
        }
        return {{}, {}, scattered(grid.index(grid.cell_at(point)), forward)};
    }
    ScatteredLight on_surface(const SurfaceHit& hit) const override {
        return {{}, {}, on_patches_(hit, solution_.patches)};
    }

  private:
    Vec3f scattered(std::size_t zone, const Vec3d& forward) const {
        Vec3f sum;
        float norm = 0;
        for (std::size_t m = 0; m < set_.size(); ++m) {
            const float share = static_cast<float>(set_.weight[m]) *
                                value(phase_, static_cast<float>(-dot(forward, set_.direction[m])));
            sum += share * solution_.radiance[zone * set_.size() + m];
            norm += share;
        }
        return sum / Vec3f(norm);
    }

    std::unique_ptr<const Enclosure> enclosure_;
    PatchInterpolation on_patches_;
    OrdinateSet set_;
    OrdinateSolution solution_;
    Camera camera_;
    PhaseFunction phase_;
    std::vector<Vec3f> towards_;
};

// Light that comes straight to patches, irradiance over pi.
std::vector<Vec3f> first_on_patches(const Enclosure& enclosure, const FirstLight& light) {
    std::vector<Vec3f> first(enclosure.patches.size());
    parallel_for(static_cast<int>(first.size()), 16, [&](int i) {
        const auto p = static_cast<std::size_t>(i);
        const std::vector<SurfaceHit>& places = enclosure.patches[p].places;
        for (std::size_t k = 0; k < places.size(); ++k) {
            first[p] += light.at_surface(places[k], static_cast<int>(k));
        }
        first[p] = first[p] / Vec3f(static_cast<float>(places.size()));
    });
    return first;
}

void append(std::vector<Vec3f>& to, const std::vector<Vec3f>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// What glows by itself, as a source by element.
std::vector<Vec3f> glow_of(const Enclosure& enclosure) {
    std::vector<Vec3f> glow = enclosure.grid.emission;
    glow.resize(enclosure.elements());
    return glow;
}

bool is_black(const std::vector<Vec3f>& light) {
    return std::all_of(light.begin(), light.end(),
                       [](const Vec3f& v) { return max_component(v) <= 0; });
}

class ZoneLight {
  public:
    ZoneLight(const View& view, const Box3d& media, const ZonalParams& params, Job& job)
        : view_(view), params_(params), job_(job), enclosure_(std::make_unique<Enclosure>()) {
        has_ordinates_ = params.solver == ZonalSolver::Ordinates;
        scattering_ = has_ordinates_ ? ZoneScattering::Plain : ZoneScattering::Reduced;
        Box3d box = media;
        if (params.surfaces && !view.surfaces.bounds().is_empty()) {
            box.extend(view.surfaces.bounds());
        }
        // Walls that touch the media lie inside.
        const Vec3d margin(1e-4 * max_component(box.size()));
        box_ = {box.lo - margin, box.hi + margin};
        cells_ = zone_cells(box_, params.zones);
        enclosure_->grid = zones_of(scattering_);
        check_thickness(media);
        enclosure_->lines = params.lines;
        enclosure_->surfaces = &view.surfaces;
        find_patches(*enclosure_, params.light_samples);
    }

    std::unique_ptr<ScatteredSource> solve() { return has_ordinates_ ? by_ordinates() : evenly(); }

  private:
    ZoneGrid zones_of(ZoneScattering scattering) {
        constexpr int points = 6;  // per edge of a zone
        return make_zones(view_.media, box_, cells_, points, scattering, job_);
    }

    void check_thickness(const Box3d& media) const {
        const double thickness = enclosure_->grid.thickness();
        if (thickness <= params_.thickness) return;
        const int needed =
            static_cast<int>(std::ceil(1.05 * params_.zones * thickness / params_.thickness));
        const std::string what = fmt::format(
            "zones are optically {:.2g} thick, at most {:.2g} are "
            "allowed for",
            thickness, params_.thickness);
        const Vec3d size = media.size();
        throw Error(
            ErrorKind::Usage, "zonal",
            what + fmt::format(" (media of {:.3g} x {:.3g} x {:.3g} m)", size.x, size.y, size.z),
            needed <= 96 ? fmt::format("set render.zonal.zones to {}, or take method "
                                       "'diffusion' or 'path'",
                                       needed)
                         : "the media are too large for this method: take 'diffusion', or "
                           "'path'");
    }

    void announce(std::string_view how, std::int64_t bytes) const {
        job_.info(fmt::format("zonal: {} x {} x {} zones, {} patches, {}: {:.3g} MB", cells_.x,
                              cells_.y, cells_.z, enclosure_->patches.size(), how,
                              static_cast<double>(bytes) / (1 << 20)));
    }

    // Sources of the first scattering: sources are per element what is scattered of `first` light.
    std::vector<Vec3f> scattered_once(const std::vector<Vec3f>& first) const {
        std::vector<Vec3f> source = scattering_of_elements(*enclosure_);
        for (std::size_t i = 0; i < source.size(); ++i) source[i] = source[i] * first[i];
        return source;
    }

    std::unique_ptr<ScatteredSource> evenly() {
        const auto limit = params_.memory_limit << 20;
        std::size_t elements = enclosure_->patches.size();
        for (const Vec3f& s : enclosure_->grid.scattering) elements += max_component(s) > 0 ? 1 : 0;
        const std::int64_t matrix = ExchangeMatrix::bytes(elements, enclosure_->grid.is_grey);
        const bool has_matrix = params_.solver == ZonalSolver::Exchange ||
                                (params_.solver == ZonalSolver::Auto && matrix <= limit);
        // Sweeps keep sums of each task, twice while they are made.
        const auto sums =
            static_cast<std::int64_t>(enclosure_->elements() * sizeof(Vec3f) * (line_tasks + 8));
        announce(has_matrix ? "exchange factors" : "sweeps without a matrix",
                 has_matrix ? matrix + sums : sums);

        const ZoneSweep sweep(*enclosure_, job_);
        std::vector<Vec3f> first =
            FirstLight(view_, enclosure_->grid, params_.light_samples).mean_radiance(job_);
        append(first, first_on_patches(*enclosure_,
                                       FirstLight(view_, enclosure_->grid, params_.light_samples)));
        if (const std::vector<Vec3f> glow = glow_of(*enclosure_); !is_black(glow)) {
            const std::vector<Vec3f> seen = sweep.mean_radiance(sweep(glow, false));
            for (std::size_t i = 0; i < first.size(); ++i) first[i] += seen[i];
        }
        const ZoneSolution light = solve_zones(
            sweep, scattered_once(first), has_matrix ? ZoneSolver::Exchange : ZoneSolver::Sweeps,
            {params_.tolerance, params_.iterations, limit}, job_);
        std::vector<Vec3f> reduced = light.arriving, plain = first;
        if (is_uneven()) plain = first_as_it_is();
        for (std::size_t i = 0; i < reduced.size(); ++i) reduced[i] += first[i];
        return std::make_unique<EvenZones>(std::move(enclosure_), std::move(reduced),
                                           std::move(plain));
    }

    bool is_uneven() const {
        return std::any_of(view_.media.begin(), view_.media.end(),
                           [](const auto& m) { return std::abs(mean_cosine(m->phase())) > 1e-6; });
    }

    // Light that was not scattered at all, through the media as they are.
    std::vector<Vec3f> first_as_it_is() {
        Enclosure plain;
        plain.grid = zones_of(ZoneScattering::Plain);
        plain.lines = params_.lines;
        plain.surfaces = &view_.surfaces;
        find_patches(plain, params_.light_samples);
        const FirstLight light(view_, plain.grid, params_.light_samples);
        std::vector<Vec3f> first = light.mean_radiance(job_);
        append(first, first_on_patches(plain, light));
        if (const std::vector<Vec3f> glow = glow_of(plain); !is_black(glow)) {
            const ZoneSweep sweep(plain, job_);
            const std::vector<Vec3f> seen = sweep.mean_radiance(sweep(glow, false));
            for (std::size_t i = 0; i < first.size(); ++i) first[i] += seen[i];
        }
        return first;
    }

    const PhaseFunction& the_phase() const {
        const Medium* of = nullptr;
        for (const auto& m : view_.media) {
            if (max_component(m->cross_sections().scattering) == 0) continue;
            const bool differs =
                of && std::abs(mean_cosine(of->phase()) - mean_cosine(m->phase())) > 1e-6;
            if (differs) {
                throw Error(ErrorKind::Usage, "zonal",
                            "ordinates know one phase function, but media have several",
                            "take solver = \"auto\", or method 'path'");
            }
            of = m.get();
        }
        return of ? of->phase() : view_.media.front()->phase();
    }

    std::unique_ptr<ScatteredSource> by_ordinates() {
        if (params_.ordinates % 2 != 0) {
            throw Error(ErrorKind::Usage, "zonal",
                        fmt::format("{} ordinates are an odd number", params_.ordinates),
                        "the cosines of both halves are the same: take an even number");
        }
        OrdinateSet set(params_.ordinates / 2, params_.ordinates / 2);
        const std::size_t zones = enclosure_->grid.size(), n = set.size();
        const std::int64_t bytes = ordinate_bytes(zones, n);
        announce(fmt::format("{} ordinates", n), bytes);
        if (bytes > params_.memory_limit << 20) {
            throw Error(ErrorKind::Resource, "zonal",
                        fmt::format("{} zones with {} ordinates take {} MB", zones, n, bytes >> 20),
                        "raise render.zonal.memory_limit, or take fewer of them");
        }
        const PhaseFunction phase = the_phase();
        const std::vector<float> kernel = scattering_kernel(set, phase);
        const FirstLight light(view_, enclosure_->grid, params_.light_samples);
        std::vector<Vec3f> source(zones * n);
        parallel_for(static_cast<int>(zones), 8, [&](int i) {
            const auto z = static_cast<std::size_t>(i);
            if (!(max_component(enclosure_->grid.scattering[z]) > 0)) return;
            scatter_first(light, set, phase, z, {source.data() + z * n, n});
        });
        add_scattered_glow(source, n);
        std::vector<Vec3f> on_patches = first_on_patches(*enclosure_, light);
        for (std::size_t i = 0; i < on_patches.size(); ++i) {
            on_patches[i] = on_patches[i] * enclosure_->patches[i].albedo;
        }
        OrdinateSolution solution = solve_ordinates(*enclosure_, set, kernel, source, on_patches,
                                                    {params_.tolerance, params_.iterations}, job_);
        return std::make_unique<OrdinateZones>(std::move(enclosure_), std::move(set),
                                               std::move(solution), view_.camera, phase);
    }

    // The light of the lights, scattered along the ordinates.
    void scatter_first(const FirstLight& light, const OrdinateSet& set, const PhaseFunction& phase,
                       std::size_t zone, std::span<Vec3f> source) const {
        std::vector<float> share(set.size());
        light.for_zone(zone, [&](const Vec3d& direction, const Vec3f& weight) {
            float norm = 0;
            for (std::size_t m = 0; m < share.size(); ++m) {
                share[m] = value(phase, static_cast<float>(-dot(direction, set.direction[m])));
                norm += static_cast<float>(set.weight[m]) * share[m];
            }
            for (std::size_t m = 0; m < share.size(); ++m) {
                source[m] += (share[m] / norm) * enclosure_->grid.scattering[zone] * weight;
            }
        });
    }

    // A glow is scattered as if it came evenly: its light is broad.
    void add_scattered_glow(std::vector<Vec3f>& source, std::size_t ordinates) const {
        const std::vector<Vec3f> glow = glow_of(*enclosure_);
        if (is_black(glow)) return;
        const ZoneSweep sweep(*enclosure_, job_);
        const std::vector<Vec3f> seen = sweep.mean_radiance(sweep(glow, false));
        for (std::size_t i = 0; i < source.size(); ++i) {
            const std::size_t zone = i / ordinates;
            source[i] += enclosure_->grid.scattering[zone] * seen[zone];
        }
    }

    const View& view_;
    const ZonalParams& params_;
    Job& job_;
    bool has_ordinates_ = false;
    ZoneScattering scattering_ = ZoneScattering::Reduced;
    Box3d box_;
    Vec3i cells_;
    std::unique_ptr<Enclosure> enclosure_;
};

}  // namespace

std::unique_ptr<ScatteredSource> light_of_zones(const View& view, const Box3d& media,
                                                const ZonalParams& params, Job& job) {
    const PhaseTimer timer(job, "light");
    return ZoneLight(view, media, params, job).solve();
}

}  // namespace gischt
