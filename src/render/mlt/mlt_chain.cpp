// SPDX-License-Identifier: Apache-2.0
#include "render/mlt/mlt_chain.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "image/color.h"

namespace gischt {
namespace {

// Tracks of primary numbers: the choices, the film, the numbers of a connection, and the two
// subpaths, interleaved.
enum : std::size_t { TrackChoices, TrackFilm, TrackConnection, TrackCamera, TrackLight };
static_assert(TrackFilm == MltPaths::film_track);

constexpr std::size_t every_vertex = 1'000'000;

}  // namespace

MltPaths::MltPaths(const BdptScene& scene, const MltParams& params, int depth, double margin)
    : scene_(scene),
      margin_(margin),
      tracer_(scene, depth, margin),
      least_vertices_(params.direct ? 4 : 3) {}

MltPaths::Aim MltPaths::aim(PrimaryNumbers& numbers) const {
    TrackSource choices(numbers, TrackChoices, 0), film(numbers, TrackFilm, 0);
    Aim a;
    const double width = scene_.view.width() + 2 * margin_,
                 height = scene_.view.height() + 2 * margin_;
    a.x = static_cast<double>(film.next()) * width - margin_;
    a.y = static_cast<double>(film.next()) * height - margin_;
    a.lens.x = choices.next();
    a.lens.y = choices.next();
    a.hero = std::min(static_cast<int>(3 * choices.next()), scene_.path.is_grey ? 0 : 2);
    return a;
}

// Subpaths of at most so many vertices. What comes first does not depend on how many.
void MltPaths::trace(PrimaryNumbers& numbers, const Aim& a, std::size_t s, std::size_t t) {
    TrackSource camera(numbers, TrackCamera, 2), light(numbers, TrackLight, 2);
    RandomStream random;
    random.source = &camera;
    tracer_.trace_camera(scene_.view.camera.ray(a.x, a.y, a.lens), a.hero, random, {t, true});
    if (s < 2 || (s < every_vertex && tracer_.camera().vertices.size() < t)) return;
    random.source = &light;
    light.begin(0);
    LightNumbers start;
    start.choice = light.next();
    start.extra = light.next();
    start.place = random.two();
    start.direction = random.two();
    tracer_.trace_light(start, a.hero, random, {s, true});
}

// Whether the subpaths are long enough, and it is not for plain sampling.
bool MltPaths::is_wanted(std::size_t s, std::size_t t) const {
    if (s + t < least_vertices_) return false;
    const auto& eye = tracer_.camera().vertices;
    if (s > 0) return eye.size() >= t && (s == 1 || tracer_.light().vertices.size() >= s);
    // A path that finds a light may end there, on its way, or by leaving the scene.
    if (eye.size() + 1 < t) return false;
    const PathVertex& last = eye[t - 2];
    return last.events + (last.is_delta ? 0 : 1) > 0;
}

MltSample MltPaths::contribution(PrimaryNumbers& numbers, const Aim& a, std::size_t s,
                                 std::size_t t) {
    MltSample sample{s, t, {}, 0};
    if (!is_wanted(s, t)) return sample;
    TrackSource connection(numbers, TrackConnection, 0);
    RandomStream random;
    random.source = &connection;
    if (t == 1) {
        sample.splat = tracer_.splatted(s, a.lens, random);
    } else {
        // Places on the film are drawn evenly, in a margin too.
        const View& view = scene_.view;
        const double pixels = static_cast<double>(view.width()) * view.height();
        const double all = (view.width() + 2 * margin_) * (view.height() + 2 * margin_);
        const Vec3f radiance = s == 0   ? tracer_.found(t)
                               : s == 1 ? tracer_.sampled(t, random)
                                        : tracer_.connected(s, t, random);
        sample.splat = {{static_cast<float>(a.x), static_cast<float>(a.y)},
                        radiance * static_cast<float>(all / pixels)};
    }
    sample.brightness = static_cast<double>(luminance(sample.splat.value));
    if (!(sample.brightness > 0) || !Film::is_countable(sample.splat)) sample.brightness = 0;
    return sample;
}

MltSample MltPaths::one(PrimaryNumbers& numbers, std::size_t s, std::size_t t) {
    const Aim a = aim(numbers);
    trace(numbers, a, s, t);
    return contribution(numbers, a, s, t);
}

double MltPaths::all(PrimaryNumbers& numbers, std::vector<MltSample>& samples) {
    samples.clear();
    const Aim a = aim(numbers);
    trace(numbers, a, every_vertex, every_vertex);
    const std::size_t eyes = tracer_.camera().vertices.size(),
                      lights = tracer_.light().vertices.size();
    double sum = 0;
    const auto add = [&](std::size_t s, std::size_t t) {
        const MltSample sample = contribution(numbers, a, s, t);
        if (!(sample.brightness > 0)) return;
        sum += sample.brightness;
        samples.push_back(sample);
    };
    for (std::size_t t = 2; t <= eyes + 1; ++t) add(0, t);
    for (std::size_t t = 2; t <= eyes; ++t) {
        for (std::size_t s = 1; s <= std::max<std::size_t>(lights, 1); ++s) add(s, t);
    }
    for (std::size_t s = 2; s <= lights; ++s) add(s, 1);
    return sum;
}

namespace {

// The start of a path of the pool.
std::uint64_t pool_key(std::uint64_t key, std::int64_t i) {
    return random_key(key, 1, static_cast<std::uint64_t>(i));
}

// One chain. A splat counts by the share of the time that the chain is there: that of a proposal is
// its chance to be accepted (Veach 1997, 11.4).
//
// A proposal to start anew takes all numbers anew, and a strategy in proportion to the brightness
// of what they make; so it is accepted with the chance min(1, S' / S), S being the sum over the
// strategies, and its time is shared among them.
class Chain {
  public:
    Chain(const MltParams& params, MltPaths& paths, PrimaryNumbers numbers, std::uint64_t key,
          double mean)
        : params_(params), paths_(paths), numbers_(std::move(numbers)), mean_(mean) {
        sum_ = paths_.all(numbers_, fresh_);
        choices_ = random_key(key, 1);
        now_ = drawn(random_uniform(choices_, counter_++));
        numbers_.mutate_by(random_key(key, 0), params.sigma);
    }

    std::vector<FilmSplat> run(std::int64_t mutations, Job& job) {
        for (std::int64_t m = 0; m < mutations; ++m) {
            if (m % 256 == 0) job.check();
            const auto kind = static_cast<double>(random_uniform(choices_, counter_++));
            if (kind < params_.large_step) {
                start_anew();
            } else {
                if (kind < params_.large_step + params_.film_step) {
                    numbers_.propose_track(MltPaths::film_track);
                } else {
                    numbers_.propose(false);
                }
                vary();
            }
        }
        put(now_, stayed_);
        return std::move(out_);
    }

  private:
    bool is_taken(double chance) {
        return static_cast<double>(random_uniform(choices_, counter_++)) < chance;
    }
    // One of the strategies of a fresh start.
    MltSample drawn(float u) const {
        double left = static_cast<double>(u) * sum_;
        for (const MltSample& s : fresh_) {
            left -= s.brightness;
            if (left < 0) return s;
        }
        return fresh_.empty() ? MltSample{} : fresh_.back();
    }
    void put(const MltSample& s, double time) {
        if (!(time > 0) || !(s.brightness > 0)) return;
        out_.push_back(
            {s.splat.at, s.splat.value * static_cast<float>(mean_ * time / s.brightness)});
    }

    void vary() {
        const MltSample next = paths_.one(numbers_, now_.s, now_.t);
        const double accept =
            now_.brightness > 0 ? std::min(1.0, next.brightness / now_.brightness) : 1;
        stayed_ += 1 - accept;
        if (is_taken(accept)) {
            put(now_, stayed_);
            stayed_ = accept;
            now_ = next;
            sum_ = -1;
            numbers_.accept();
        } else {
            put(next, accept);
            numbers_.reject();
        }
    }

    void start_anew() {
        if (sum_ < 0) sum_ = paths_.all(numbers_, fresh_);
        const double before = sum_;
        numbers_.propose(true);
        const double after = paths_.all(numbers_, fresh_);
        const double accept = before > 0 ? std::min(1.0, after / before) : 1;
        for (const MltSample& s : fresh_) put(s, accept * s.brightness / after);
        stayed_ += 1 - accept;
        if (is_taken(accept)) {
            put(now_, stayed_);
            stayed_ = 0;
            sum_ = after;
            now_ = drawn(random_uniform(choices_, counter_++));
            numbers_.accept();
        } else {
            numbers_.reject();
        }
    }

    const MltParams& params_;
    MltPaths& paths_;
    PrimaryNumbers numbers_;
    double mean_;  // brightness of the picture
    std::uint64_t choices_ = 0;
    std::uint32_t counter_ = 0;
    MltSample now_;
    double stayed_ = 0;             // time that is not put down yet
    double sum_ = -1;               // over the strategies of the numbers; -1: not known
    std::vector<MltSample> fresh_;  // all of them, of the last fresh start
    std::vector<FilmSplat> out_;
};

}  // namespace

std::vector<std::vector<FilmSplat>> paint_round(const MltRound& round, const MltParams& params,
                                                std::uint64_t key, const MltPathsMaker& make,
                                                Job& job) {
    std::vector<double> brightness(static_cast<std::size_t>(round.pool));
    parallel_ranges(static_cast<int>(round.pool), 64, [&](int begin, int end) {
        const auto paths = make();
        std::vector<MltSample> samples;
        for (int i = begin; i < end; ++i) {
            if (i % 256 == 0) job.check();
            PrimaryNumbers numbers(pool_key(key, i));
            brightness[static_cast<std::size_t>(i)] = paths->all(numbers, samples);
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
        out[static_cast<std::size_t>(c)] =
            Chain(params, *paths, PrimaryNumbers(pool_key(key, start)), chain, mean)
                .run(last - first, job);
    });
    return out;
}

}  // namespace gischt
