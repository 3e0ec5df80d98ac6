// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/mlt_chain.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "image/color.h"
#include "optics/material.h"

namespace gischt {
namespace {

// Tracks of primary numbers: the choices, the numbers of the connection, and the two subpaths,
// interleaved.
enum : std::size_t { TrackChoices, TrackFilm, TrackConnection, TrackCamera, TrackLight };

// Edges of a path beside those between its scatterings: turns into single directions, as many as
// the path tracer takes.
constexpr std::size_t most_deltas = 64;

bool has_single_directions(const View& view) {
    for (int i = 0; i < view.surfaces.size(); ++i) {
        const MaterialKind kind = view.surfaces.info(i).material;
        if (kind != MaterialKind::Lambert && kind != MaterialKind::None) return true;
    }
    return false;
}

}  // namespace

MltPaths::MltPaths(const BdptScene& scene, const MltParams& params, int depth, double margin)
    : scene_(scene),
      params_(params),
      margin_(margin),
      tracer_(scene, depth, margin),
      least_(params.direct ? 3 : 2) {
    const auto most =
        static_cast<std::size_t>(depth) + 1 + (has_single_directions(scene.view) ? most_deltas : 0);
    double sum = 0;
    // Short paths bring most, long ones less and less.
    for (std::size_t k = least_; k <= most; ++k) {
        sum += 1 / std::pow(static_cast<double>(k) - 1, 2);
        cumulative_.push_back(sum);
    }
    for (double& c : cumulative_) c /= sum;
}

MltSample MltPaths::operator()(PrimaryNumbers& numbers) {
    if (cumulative_.empty()) return {};
    TrackSource choices(numbers, TrackChoices, 0), film(numbers, TrackFilm, 0);
    TrackSource connection(numbers, TrackConnection, 0);
    TrackSource camera(numbers, TrackCamera, 2), light(numbers, TrackLight, 2);
    const View& view = scene_.view;

    // How many edges, and which strategy.
    const auto u = static_cast<double>(choices.next());
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
    const auto place = static_cast<std::size_t>(found - cumulative_.begin());
    const double chance = cumulative_[place] - (place > 0 ? cumulative_[place - 1] : 0);
    const std::size_t k = least_ + place, n = k + 1;
    const auto ways = static_cast<double>(n);
    const std::size_t s = std::min(static_cast<std::size_t>(choices.next() * static_cast<float>(n)),
                                   n - 1),
                      t = n - s;
    const int hero = std::min(static_cast<int>(3 * choices.next()), scene_.path.is_grey ? 0 : 2);

    // Where on the film, and through which point of the lens.
    const double width = view.width() + 2 * margin_, height = view.height() + 2 * margin_;
    const double x = static_cast<double>(film.next()) * width - margin_,
                 y = static_cast<double>(film.next()) * height - margin_;
    const float lens_x = choices.next();
    const Vec2f lens{lens_x, choices.next()};

    RandomStream random;
    random.source = &camera;
    tracer_.trace_camera(view.camera.ray(x, y, lens), hero, random, {t, false});
    const auto& eye = tracer_.camera().vertices;
    random.source = &light;
    if (s >= 2 && eye.size() == t) {
        LightNumbers start;
        light.begin(0);
        start.choice = light.next();
        start.extra = light.next();
        start.place = random.two();
        start.direction = random.two();
        tracer_.trace_light(start, hero, random, {s, false});
    }
    random.source = &connection;

    MltSample sample;
    const auto complete = [&](const Vec3f& radiance) {
        const double pixels = static_cast<double>(view.width()) * view.height();
        sample.splat = {{static_cast<float>(x), static_cast<float>(y)},
                        radiance * static_cast<float>(width * height / pixels)};
    };
    if (s == 0) {
        // The last vertex is one on a light, or none where the path leaves or a medium glows.
        if (eye.size() + 1 >= t && eye.size() >= 2) {
            const PathVertex& last = eye[t - 2];
            if (last.events + (last.is_delta ? 0 : 1) > 0 && t >= 3) {
                complete(tracer_.found(t));
            }
        }
    } else if (eye.size() == t && (s == 1 || tracer_.light().vertices.size() == s)) {
        if (t == 1) {
            sample.splat = tracer_.splatted(s, lens, random);
        } else {
            complete(s == 1 ? tracer_.sampled(t, random) : tracer_.connected(s, t, random));
        }
    }
    sample.splat.value *= static_cast<float>(ways / chance);
    sample.brightness = static_cast<double>(luminance(sample.splat.value));
    if (!(sample.brightness > 0) || !Film::is_countable(sample.splat)) return {};
    return sample;
}

namespace {

// The start of a path of the pool.
std::uint64_t pool_key(std::uint64_t key, std::int64_t i) {
    return random_key(key, 1, static_cast<std::uint64_t>(i));
}

// The mutations of one chain, each splat weighed by its share of the time that the chain was there:
// that of a proposal is its chance to be accepted (Veach 1997, 11.4).
std::vector<FilmSplat> run_chain(PrimaryNumbers numbers, std::uint64_t key, std::int64_t mutations,
                                 double scale, const MltParams& params, MltPaths& paths, Job& job) {
    std::vector<FilmSplat> out;
    MltSample now = paths(numbers);
    numbers.mutate_by(random_key(key, 0), params.sigma);
    const std::uint64_t choices = random_key(key, 1);
    double stayed = 0;
    const auto put = [&](const MltSample& s, double time) {
        if (!(time > 0) || !(s.brightness > 0)) return;
        out.push_back(
            {s.splat.at, s.splat.value * static_cast<float>(scale * time / s.brightness)});
    };
    for (std::int64_t m = 0; m < mutations; ++m) {
        if (m % 256 == 0) job.check();
        const auto i = static_cast<std::uint32_t>(2 * m);
        const auto kind = static_cast<double>(random_uniform(choices, i));
        if (kind < params.large_step + params.film_step && kind >= params.large_step) {
            numbers.propose_track(TrackFilm);
        } else {
            numbers.propose(kind < params.large_step);
        }
        const MltSample next = paths(numbers);
        const double accept =
            now.brightness > 0 ? std::min(1.0, next.brightness / now.brightness) : 1;
        stayed += 1 - accept;
        if (static_cast<double>(random_uniform(choices, i + 1)) < accept) {
            put(now, stayed);
            stayed = accept;
            now = next;
            numbers.accept();
        } else {
            put(next, accept);
            numbers.reject();
        }
    }
    put(now, stayed);
    return out;
}

}  // namespace

std::vector<std::vector<FilmSplat>> paint_round(const MltRound& round, const MltParams& params,
                                                std::uint64_t key, const MltPathsMaker& make,
                                                Job& job) {
    std::vector<double> brightness(static_cast<std::size_t>(round.pool));
    parallel_ranges(static_cast<int>(round.pool), 64, [&](int begin, int end) {
        const auto paths = make();
        for (int i = begin; i < end; ++i) {
            if (i % 256 == 0) job.check();
            PrimaryNumbers numbers(pool_key(key, i));
            brightness[static_cast<std::size_t>(i)] = (*paths)(numbers).brightness;
        }
    });
    std::vector<double> cumulative;
    double sum = 0;
    for (const double b : brightness) cumulative.push_back(sum += b);
    std::vector<std::vector<FilmSplat>> out(static_cast<std::size_t>(round.chains));
    if (!(sum > 0)) return out;
    const double mean = sum / static_cast<double>(round.pool);
    parallel_for(round.chains, 1, [&](int c) {
        const auto paths = make();
        const std::uint64_t chain = random_key(key, 2, static_cast<std::uint64_t>(c));
        // The chains' starts are spread over the pool.
        const double u =
            (c + static_cast<double>(random_uniform(random_key(key, 3), 0))) / round.chains;
        const auto start = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u * sum) -
                           cumulative.begin();
        const std::int64_t first = round.mutations * c / round.chains,
                           last = round.mutations * (c + 1) / round.chains;
        out[static_cast<std::size_t>(c)] = run_chain(PrimaryNumbers(pool_key(key, start)), chain,
                                                     last - first, mean, params, *paths, job);
    });
    return out;
}

}  // namespace gischt
