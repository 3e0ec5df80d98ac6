// SPDX-License-Identifier: Apache-2.0
#include "optics/layer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "math/quadrature.h"

namespace gischt {
namespace {

constexpr int most_halvings = 32;
constexpr double never = std::numeric_limits<double>::infinity();

void check_positive(const char* what, double value) {
    if (value > 0) return;
    throw Error(ErrorKind::Usage, "layer", fmt::format("the {} is {}", what, value),
                "it must be positive");
}

// The heights at which a profile passes powers of two, with both ends of what is there.
std::vector<double> breaks_of(const HeightProfile& p, double top) {
    std::vector<double> heights;
    double lowest = 0, highest = top;
    if (p.kind == HeightProfile::Kind::Exponential) {
        for (int k = 1; k < most_halvings; ++k) heights.push_back(k * p.scale * std::log(2.0));
        highest = std::min(top, most_halvings * p.scale * std::log(2.0));
    } else {
        heights.push_back(p.center);
        for (int k = 1; k <= 6; ++k) {
            const double off = p.scale * (1 - std::ldexp(1.0, -k));
            heights.insert(heights.end(), {p.center - off, p.center + off});
        }
        lowest = std::max(0.0, p.center - p.scale);
        highest = std::min(top, p.center + p.scale);
    }
    check_positive("thickness", highest - lowest);
    std::erase_if(heights, [&](double h) { return h <= lowest || h >= highest; });
    heights.insert(heights.end(), {lowest, highest});
    std::sort(heights.begin(), heights.end());
    return heights;
}

}  // namespace

Layer::Layer(bool is_round, const Vec3d& center, double radius, const HeightProfile& profile,
             double top)
    : is_round_(is_round), center_(center), radius_(radius), profile_(profile) {
    check_positive("scale height", profile.scale);
    check_positive("top", top);
    breaks_ = breaks_of(profile, top);
    top_ = breaks_.back();
}

Layer Layer::flat(const Vec3d& up, double base, const HeightProfile& profile, double top) {
    return Layer(false, up, base, profile, top);
}

Layer Layer::round(const Vec3d& center, double radius, const HeightProfile& profile, double top) {
    check_positive("radius", radius);
    return Layer(true, center, radius, profile, top);
}

Box3d Layer::bounds() const {
    const Vec3d half(is_round_ ? radius_ + top_ : std::numeric_limits<double>::infinity());
    return is_round_ ? Box3d{center_ - half, center_ + half} : Box3d{-half, half};
}

double Layer::density(const Vec3d& point) const {
    const double h = height(point);
    if (h > top_ || (is_round_ && h < 0)) return 0;
    return profile_.density(std::max(0.0, h));
}

double Layer::greatest_density() const {
    double most = 0;
    for (const double h : breaks_) most = std::max(most, profile_.density(h));
    return most;
}

Layer::Path Layer::path(const Ray& ray) const {
    Path p{.ray = ray, .speed = length(ray.direction)};
    if (!is_round_) {
        p.height0 = height(ray.origin);
        p.slope = dot(center_, ray.direction);
        const double leaves = time_at(p, 0, top_);
        Piece piece{ray.t_min, ray.t_max, p.slope > 0 ? 1 : p.slope < 0 ? -1 : 0};
        if (piece.sign > 0) piece.t1 = std::min(piece.t1, leaves);
        if (piece.sign < 0) piece.t0 = std::max(piece.t0, leaves);
        if (piece.sign == 0 && p.height0 > top_) return p;
        if (piece.t0 < piece.t1) p.piece[static_cast<std::size_t>(p.pieces++)] = piece;
        return p;
    }
    const Vec3d from_center = ray.origin - center_;
    p.nearest_t = -dot(from_center, ray.direction) / (p.speed * p.speed);
    p.nearest = length(from_center + p.nearest_t * ray.direction);
    if (!(p.nearest < radius_ + top_)) return p;
    // Down to the nearest point, or into what is empty below, and up from there.
    for (const int sign : {-1, 1}) {
        Piece piece{time_at(p, sign, sign < 0 ? top_ : breaks_[0]),
                    time_at(p, sign, sign < 0 ? breaks_[0] : top_), sign};
        piece.t0 = std::max(piece.t0, ray.t_min);
        piece.t1 = std::min(piece.t1, ray.t_max);
        if (piece.t0 < piece.t1) p.piece[static_cast<std::size_t>(p.pieces++)] = piece;
    }
    return p;
}

double Layer::height_at(const Path& p, double t) const {
    if (!is_round_) return p.height0 + t * p.slope;
    const double s = (t - p.nearest_t) * p.speed;
    return std::sqrt(p.nearest * p.nearest + s * s) - radius_;
}

double Layer::time_at(const Path& p, int sign, double height) const {
    if (!is_round_) return (height - p.height0) / p.slope;
    const double r = radius_ + height;
    return p.nearest_t +
           sign * std::sqrt(std::max(0.0, (r - p.nearest) * (r + p.nearest))) / p.speed;
}

double Layer::integral(const Path& p, double h0, double h1, double span, bool is_short) const {
    if (!is_round_) {
        if (profile_.kind == HeightProfile::Kind::Tent) {
            return 0.5 * span * (profile_.density(h0) + profile_.density(h1));
        }
        const double x = (h1 - h0) / profile_.scale;
        return span * profile_.density(h0) * (x == 0 ? 1 : -std::expm1(-x) / x);
    }
    // With v^2 = r - r_nearest the distance from the nearest point is v sqrt(2 r_nearest + v^2),
    // and everything is smooth in v.
    static const GaussLegendre few(3), many(24);
    const double n = p.nearest, base = n - radius_;
    const double v0 = std::sqrt(std::max(0.0, h0 - base)), v1 = std::sqrt(std::max(0.0, h1 - base));
    const double integral = (is_short ? few : many).integrate(v0, v1, [&](double v) {
        const double stretch = 2 * (n + v * v) / std::sqrt(2 * n + v * v);
        return stretch * static_cast<double>(profile_.density(static_cast<float>(base + v * v)));
    });
    return std::abs(integral);
}

double Layer::column(const Ray& ray) const {
    const Path p = path(ray);
    // Where the profile has a corner.
    const double corner = is_round_ ? profile_.center : 0;
    double sum = 0;
    for (int i = 0; i < p.pieces; ++i) {
        const auto [t0, t1, sign] = p.piece[static_cast<std::size_t>(i)];
        if (sign == 0) {
            sum += (t1 - t0) * p.speed * profile_.density(std::max(0.0, p.height0));
            continue;
        }
        const double turn = std::clamp(time_at(p, sign, corner), t0, t1);
        const double low0 = sign > 0 ? t0 : turn, low1 = sign > 0 ? turn : t1;
        const auto part = [&](double a, double b) {
            return integral(p, height_at(p, a), height_at(p, b), (b - a) * p.speed, false);
        };
        if (low0 < low1) {
            sum += is_round_ ? part(low0, low1) : (low1 - low0) * p.speed * profile_.density(0.0);
        }
        const double high0 = sign > 0 ? turn : t0, high1 = sign > 0 ? t1 : turn;
        if (high0 < high1) sum += part(high0, high1);
    }
    return sum;
}

LayerWalk::LayerWalk(const Layer& layer, const Ray& ray) : layer_(&layer), path_(layer.path(ray)) {
    start_piece();
}

void LayerWalk::start_piece() {
    if (++piece_ >= path_.pieces) return;
    const Layer::Piece& p = path_.piece[static_cast<std::size_t>(piece_)];
    t_ = p.t0;
    const std::vector<double>& b = layer_->breaks_;
    const double h = height_ = layer_->height_at(path_, t_);
    // A ray that falls from a break belongs to the band below.
    const auto above = p.sign < 0 ? std::lower_bound(b.begin(), b.end(), h)
                                  : std::upper_bound(b.begin(), b.end(), h);
    band_ = std::clamp(static_cast<int>(above - b.begin()) - 1, layer_->is_round_ ? 0 : -1,
                       static_cast<int>(b.size()) - 2);
}

bool LayerWalk::next(LayerRun& run) {
    const std::vector<double>& b = layer_->breaks_;
    const int last = static_cast<int>(b.size()) - 2;
    for (; piece_ < path_.pieces; start_piece()) {
        const Layer::Piece& p = path_.piece[static_cast<std::size_t>(piece_)];
        while (t_ < p.t1) {
            const int band = band_;
            if (p.sign > 0 && band < last) ++band_;
            if (p.sign < 0 && band > (layer_->is_round_ ? 0 : -1)) --band_;
            // The break between the bands, or the end of the piece.
            double height = b[static_cast<std::size_t>(std::max({band, band_, 0}))];
            double t1 = band_ != band ? layer_->time_at(path_, p.sign, height) : never;
            if (!(t1 < p.t1)) {
                t1 = p.t1;
                height = layer_->height_at(path_, t1);
            }
            if (!(t1 > t_)) continue;
            fill(run, t1, height, band);
            t_ = t1;
            height_ = height;
            return true;
        }
    }
    return false;
}

void LayerWalk::fill(LayerRun& run, double t1, double height, int band) const {
    const HeightProfile& profile = layer_->profile_;
    run.t0 = t_;
    run.t1 = t1;
    run.entry = run.step = {};
    const int sign = path_.piece[static_cast<std::size_t>(piece_)].sign;
    if (band < 0 || sign == 0) {  // the same all along, and said to be so
        run.entry.x = static_cast<float>(band < 0 ? 0 : height_);
        run.min = run.mean = run.max = static_cast<double>(profile.density(run.entry.x));
        return;
    }
    const auto b = layer_->breaks_.begin() + band;
    const double h0 = std::clamp(height_, b[0], b[1]), h1 = std::clamp(height, b[0], b[1]);
    const double d0 = profile.density(h0), d1 = profile.density(h1);
    const double span = (t1 - t_) * path_.speed;
    run.min = std::min(d0, d1);
    run.max = std::max(d0, d1);
    run.mean = std::clamp(layer_->integral(path_, h0, h1, span, true) / span, run.min, run.max);
    if (layer_->is_round_) {
        const double s = (t_ - path_.nearest_t) * path_.speed;
        run.entry = Vec3f(Vec3d(height_, height_ + layer_->radius_, 0));
        run.step = Vec3f(Vec3d(2 * s * path_.speed, path_.speed * path_.speed, 0));
    } else {
        run.entry.x = static_cast<float>(height_);
        run.step.x = static_cast<float>(path_.slope);
    }
    // The float of look-ups on the run; where a tent ends it is the rounding of 1 - 1.
    const double ends = profile.kind == HeightProfile::Kind::Tent ? 1e-6 : 0;
    run.min = std::max(0.0, run.min * (1 - 1e-5) - ends);
    run.max = run.max * (1 + 1e-5) + ends;
}

}  // namespace gischt
