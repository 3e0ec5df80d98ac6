// SPDX-License-Identifier: Apache-2.0
#include "render/path/tracking.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/fast_math.h"
#include "render/path/dense_run.h"
#include "render/path/media_walk.h"

namespace gischt {
namespace {

// -log(1 - u), finite for u in [0, 1).
float exponential(float u) {
    return -fast_log(1 - u);
}

// A stretch that glows with next to no density still needs tentative collisions to see it.
float with_floor(const MediaRun& run, bool is_emissive) {
    if (!is_emissive || run.emission_max == 0) return run.max;
    return std::max(run.max, 1 / static_cast<float>(run.t1 - run.t0));
}

Vec3f color_of(const ActiveMedium& a, double t) {
    if (!a.medium->has_color()) return Vec3f(1);
    return a.medium->color_at(a.segment, static_cast<float>(t - a.segment.anchor), a.density(t));
}

}  // namespace

Vec3f extinction_at(const MediaRun& run, double t) {
    Vec3f sum;
    for (const ActiveMedium& a : run.active) {
        sum += a.density(t) * a.medium->cross_sections().extinction();
    }
    return sum;
}

// Adds the emission at t of all media.
void Tracker::meet_glow(const MediaRun& run, double t, const Vec3f& weight, Vec3f& emission) {
    Vec3f sum;
    for (const ActiveMedium& a : run.active) {
        if (a.segment.emission_max == 0) continue;
        const auto at = static_cast<float>(t - a.segment.anchor);
        const Vec3f one = a.medium->emission_at(a.segment, at, a.medium->density_at(a.segment, at));
        sum += one;
        if (glows && max_component(one) > 0) glows->push_back({t, a.index, weight * one});
    }
    emission += weight * sum;
}

// Whether a tentative collision is a real one, and with which medium: `u` is uniform in [0, 1). The
// hero's extinctions share [0, 1) with the null collision at its end.
bool Tracker::choose_medium(const MediaRun& run, double t, int hero, float majorant, float u,
                            PathWeight& weight, Collision& end) {
    const float at = u * majorant;
    if (is_grey && run.active.size() == 1) {
        const ActiveMedium& a = run.active[0];
        if (at >= run.min) {
            ++lookups;
            if (at >= a.density(t) * a.medium->strength()) return false;
        }
        end = {t, a.index, color_of(a, t)};
        return true;
    }
    Vec3f total;
    float below = 0;
    bool is_real = false;
    for (const ActiveMedium& a : run.active) {
        ++lookups;
        const float density = a.density(t);
        const Vec3f extinction = density * a.medium->cross_sections().extinction();
        total += extinction;
        below += extinction[hero];
        if (!is_real && at < below) {
            is_real = true;
            end = {t, a.index, color_of(a, t)};
            const Vec3f ratio = extinction / Vec3f(extinction[hero]);
            weight.weight = weight.weight * ratio;
            weight.rate = weight.rate * ratio;
        }
    }
    if (is_real) return true;
    const Vec3f null = max(Vec3f(1) - total / Vec3f(majorant), Vec3f(0));
    if (null[hero] == 0) return false;  // but for rounding it cannot be
    const Vec3f ratio = null / Vec3f(null[hero]);
    weight.weight = weight.weight * ratio;
    weight.rate = weight.rate * ratio;
    return false;
}

bool Tracker::fly(const Ray& ray, int hero, PathWeight& weight, RandomStream& random,
                  Collision& end, Vec3f* emission) {
    constexpr int most_nulls = 64;  // of one run, then it is cut into cells
    MediaWalk walk(media, ray, BrickGrain::Bricks);
    MediaRun run;
    float depth_to_go = exponential(random.leading());
    while (walk.next(run)) {
        const float majorant = with_floor(run, is_emissive);
        if (majorant == 0) continue;
        double t = run.t0;
        for (int nulls = 0;; ++nulls) {
            // The rest of the run by another estimator of the same; depth_to_go was not looked at.
            if (nulls >= most_nulls && has_cells(run)) {
                if (fly_by_cells(run, t, hero, weight, random, end, emission)) return true;
                break;
            }
            const double left = static_cast<double>(majorant) * (run.t1 - t);
            if (static_cast<double>(depth_to_go) >= left) {
                depth_to_go -= static_cast<float>(left);
                break;
            }
            t += static_cast<double>(depth_to_go / majorant);
            depth_to_go = exponential(random.next());
            if (emission && is_emissive) {
                meet_glow(run, t, weight.value() * (1 / majorant), *emission);
            }
            if (choose_medium(run, t, hero, majorant, random.next(), weight, end)) return true;
        }
    }
    return false;
}

// On from t without null collisions: the cell in which the hero's optical depth runs out, and the
// place in it.
bool Tracker::fly_by_cells(const MediaRun& run, double t, int hero, PathWeight& weight,
                           RandomStream& random, Collision& end, Vec3f* emission) {
    cells_of_run(run, t, cells_, lookups);
    float depth_to_go = exponential(random.next());
    const auto pass = [hero](const PathWeight& w, const Vec3f& depth) {
        const Vec3f ratio = exp(Vec3f(depth[hero]) - depth);
        return PathWeight{w.weight * ratio, w.rate * ratio};
    };
    for (const RunCell& cell : cells_) {
        const bool collides = depth_to_go < cell.depth[hero];
        float s = cell.length;
        if (collides) {
            float low = 0;
            while (0.5f * (low + s) > low && 0.5f * (low + s) < s) {
                const float middle = 0.5f * (low + s);
                (depth_within_cell(run, cell, middle, lookups)[hero] < depth_to_go ? low : s) =
                    middle;
            }
        }
        // What glows counts at one place, if the flight comes there.
        if (emission && is_emissive) {
            const float place = random.next() * cell.length;
            if (place < s) {
                Vec3f depth = depth_within_cell(run, cell, place, lookups);
                if (depth[hero] > depth_to_go) depth *= depth_to_go / depth[hero];
                meet_glow(run, cell.t + static_cast<double>(place),
                          cell.length * pass(weight, depth).value(), *emission);
            }
        }
        if (!collides) {
            depth_to_go -= cell.depth[hero];
            weight = pass(weight, cell.depth);
            continue;
        }
        const double at = cell.t + static_cast<double>(s);
        const float total = extinction_at(run, at)[hero];
        if (total == 0) continue;  // beside a leap that is finer than what t resolves
        // So may be the depth there: it is to be the drawn one.
        const Vec3f depth = depth_within_cell(run, cell, s, lookups);
        weight = pass(weight, depth * (depth_to_go / depth[hero]));
        if (choose_medium(run, at, hero, total, random.next(), weight, end)) return true;
    }
    return false;
}

Vec3f Tracker::transmittance(const Ray& ray, TransmittanceEstimator estimator,
                             RandomStream& random) {
    if (media.empty()) return Vec3f(1);
    const auto dimmed = [this](const Vec3f& depth) {
        if (is_grey) return Vec3f(fast_exp(-depth.x));
        return Vec3f(fast_exp(-depth.x), fast_exp(-depth.y), fast_exp(-depth.z));
    };
    if (estimator == TransmittanceEstimator::Exact) return dimmed(exact_depth(ray));
    // What has a closed form needs no tracking.
    std::array<const Medium*, most_media> tracked;
    std::size_t count = 0;
    Vec3f depth;
    for (const Medium* medium : media) {
        if (medium->cell_size() > 0) {
            tracked[count++] = medium;
        } else {
            depth += static_cast<float>(exact_density_integral(*medium, ray, lookups)) *
                     medium->cross_sections().extinction();
        }
    }
    const Vec3f closed = dimmed(depth);
    if (count == 0 || max_component(closed) == 0) return closed;
    if (estimator == TransmittanceEstimator::March) {
        constexpr float steps = 1;  // see bench/transmittance_table
        return closed * march_.transmittance({tracked.data(), count}, ray, steps, random, lookups);
    }
    return closed * ratio_tracking({tracked.data(), count}, ray,
                                   estimator == TransmittanceEstimator::ResidualRatio, random);
}

// The product of the chances of a null collision in a run, `control` apart.
Vec3f Tracker::track_run(const MediaRun& run, const Vec3f& control, float majorant,
                         float& depth_to_go, RandomStream& random) {
    Vec3f product(1);
    for (double t = run.t0;;) {
        const double left = static_cast<double>(majorant) * (run.t1 - t);
        if (static_cast<double>(depth_to_go) >= left) {
            depth_to_go -= static_cast<float>(left);
            return product;
        }
        t += static_cast<double>(depth_to_go / majorant);
        depth_to_go = exponential(random.next());
        lookups += static_cast<std::int64_t>(run.active.size());
        product = product * (Vec3f(1) - (extinction_at(run, t) - control) / Vec3f(majorant));
    }
}

// Ratio tracking (Novak, Selle, Jarosz 2014). With the mean of each block as control, what remains
// is the residual around it.
Vec3f Tracker::ratio_tracking(std::span<const Medium* const> tracked, const Ray& ray,
                              bool with_control, RandomStream& random) {
    constexpr float faint = 0.05f, survival = 0.25f;
    // Expected in a run of 4^3 cells, which has at most 10 walls: from there on exact costs less.
    constexpr float most_steps = 32;
    MediaWalk walk(tracked, ray);
    MediaRun run;
    Vec3f product(1), control_depth;
    float depth_to_go = exponential(random.next());
    while (walk.next(run)) {
        const bool is_flat = run.min == run.max;
        const float residual = std::max(run.max - run.mean, run.mean - run.min);
        const float majorant = !with_control ? run.max : is_flat ? 0 : residual;
        const auto length = static_cast<float>(run.t1 - run.t0);
        if (majorant * length > most_steps) {
            control_depth += exact_depth_of_run(run, lookups);
        } else {
            Vec3f control;
            for (const ActiveMedium& a : run.active) {
                const float mean = a.segment.mean / a.medium->strength();
                if (with_control && a.segment.mean > 0) {
                    control += mean * a.medium->cross_sections().extinction();
                }
            }
            control_depth += length * control;
            if (majorant == 0) continue;
            product = product * track_run(run, control, majorant, depth_to_go, random);
        }
        // Russian roulette of what is nearly dark.
        const float left = max_component(abs(product)) * fast_exp(-min_component(control_depth));
        if (left < faint) {
            if (left == 0 || random.next() >= survival) return {};
            product *= 1 / survival;
        }
    }
    return product * Vec3f(fast_exp(-control_depth.x), fast_exp(-control_depth.y),
                           fast_exp(-control_depth.z));
}

// Of the channels that are not clear, at density 1, 1/m.
static float weakest_extinction(const Medium& medium) {
    const Vec3f extinction = medium.cross_sections().extinction();
    float weakest = medium.strength();
    for (int c = 0; c < 3; ++c) {
        if (extinction[c] > 0) weakest = std::min(weakest, extinction[c]);
    }
    return weakest;
}

double exact_density_integral(const Medium& medium, const Ray& ray, std::int64_t& lookups) {
    if (medium.strength() == 0) return 0;
    // Media without a grid know it at once.
    if (const auto depth = medium.optical_depth(ray, ray.t_min, ray.t_max)) {
        const auto sum = static_cast<double>(*depth / medium.strength());
        return std::min(sum / length(ray.direction), 1e30);
    }
    const double enough = 24.0 / static_cast<double>(weakest_extinction(medium));
    double sum = 0;
    SegmentWalk walk = medium.segments(ray, BrickGrain::Bricks);
    MediumSegment s;
    while (walk.next(s)) {
        if (s.max == 0) continue;
        sum += s.min == s.max ? static_cast<double>(s.mean / medium.strength()) * (s.t1 - s.t0)
                              : exact_integral(medium, s, lookups);
        if (sum > enough) return std::min(sum, 1e30);
    }
    return sum;
}

Vec3f Tracker::exact_depth(const Ray& ray) {
    Vec3f sum;
    for (const Medium* medium : media) {
        sum += static_cast<float>(exact_density_integral(*medium, ray, lookups)) *
               medium->cross_sections().extinction();
    }
    return sum;
}

}  // namespace gischt
