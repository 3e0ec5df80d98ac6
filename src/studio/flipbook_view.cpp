// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook_view.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/error.h"
#include "base/parallel.h"
#include "optics/light_rig.h"
#include "optics/medium.h"

namespace gischt {
namespace {

template <class P>
inline constexpr bool is_bounded_medium =
    std::is_same_v<P, BoxMedium> || std::is_same_v<P, SphereMedium>;

bool has_ends(const PlacedMediumParams& medium) {
    return std::visit([](const auto& m) { return is_bounded_medium<std::decay_t<decltype(m)>>; },
                      medium);
}

}  // namespace

Scene sprite_scene(const Scene& scene, Vec2i cell) {
    Scene sprite = scene;
    sprite.solids.clear();
    std::erase_if(sprite.media, [](const PlacedMediumParams& m) { return !has_ends(m); });
    for (AnyLightParams& light : sprite.lights) {
        std::visit(
            [](auto& l) {
                if constexpr (requires { l.camera_visible; }) l.camera_visible = false;
            },
            light);
    }
    sprite.film.width = cell.x;
    sprite.film.height = cell.y;
    sprite.film.shutter = 0;
    sprite.film.aovs.clear();
    sprite.film.denoise = false;
    return sprite;
}

bool has_glow(const Scene& scene) {
    const bool by_fluid = std::ranges::any_of(scene.fluids, [](const FluidSection& f) {
        return common_of(f).medium.emission != EmissionKind::None;
    });
    return by_fluid || std::ranges::any_of(scene.media, [](const PlacedMediumParams& medium) {
               return std::visit(
                   [](const auto& m) {
                       if constexpr (is_bounded_medium<std::decay_t<decltype(m)>>)
                           return m.medium.emission != EmissionKind::None;
                       return false;
                   },
                   medium);
           });
}

Scene without_glow(const Scene& scene) {
    Scene dark = scene;
    dark.lights.clear();
    for (FluidSection& f : dark.fluids) common_of(f).medium.emission = EmissionKind::None;
    for (PlacedMediumParams& medium : dark.media) {
        std::visit(
            [](auto& m) {
                if constexpr (requires { m.medium; }) m.medium.emission = EmissionKind::None;
            },
            medium);
    }
    return dark;
}

CameraParams camera_held_still(const CameraParams& camera, double time) {
    CameraParams still;
    still.projection = camera.projection;
    still.position = camera.position.at(time);
    still.target = camera.target.at(time);
    if (camera.up) still.up = Keyed<Vec3d>(camera.up->at(time));
    still.fov_degrees = camera.fov_degrees.at(time);
    still.height = camera.height.at(time);
    still.roll_degrees = camera.roll_degrees.at(time);
    return still;
}

// An orthographic camera gives the axes; one whose up is parallel to the view chooses another.
SpriteFit::SpriteFit(const Vec3d& forward, const Vec3d& up)
    : low_(Box3d::empty().lo), high_(Box3d::empty().hi) {
    CameraParams params;
    params.position = Vec3d{};
    params.target = forward;
    const Camera camera(params, 0, 1, 1, up);
    axis_[0] = camera.right();
    axis_[1] = camera.up();
    axis_[2] = camera.forward();
}

static CameraParams orthographic(const Vec3d& eye, const Vec3d& forward, const Vec3d& up,
                                 double height) {
    CameraParams params;
    params.projection = Projection::Orthographic;
    params.position = eye;
    params.target = eye + forward;
    params.up = Keyed<Vec3d>(up);
    params.height = height;
    return params;
}

// Whether a ray sees any of the media.
static bool is_visible(const View& view, const Ray& ray) {
    double depth = 0;
    for (const auto& m : view.media) {
        if (!m->has_lattice()) continue;
        SegmentWalk walk = m->segments(ray);
        for (MediumSegment s; walk.next(s);) {
            depth += static_cast<double>(s.mean) * (s.t1 - s.t0);
            // What is warm glows a little everywhere; what counts is a part of the brightest.
            if (m->is_emissive() && s.emission_max > 0.02f * m->emission_majorant()) return true;
        }
    }
    return depth > 0.02;
}

void SpriteFit::add(const View& view) {
    Vec3d low = Box3d::empty().lo, high = Box3d::empty().hi;
    for (const auto& m : view.media) {
        const Box3d box = m->bounds();
        if (!m->has_lattice() || box.is_empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                          corner & 4 ? box.hi.z : box.lo.z};
            const Vec3d along{dot(p, axis_[0]), dot(p, axis_[1]), dot(p, axis_[2])};
            low = min(low, along);
            high = max(high, along);
        }
    }
    if (!(low.x < high.x && low.y < high.y)) return;

    // A picture of the whole box, of about 160 x 160 pixels, tells what of it is seen.
    const double pixel = std::sqrt((high.x - low.x) * (high.y - low.y)) / 160;
    const auto columns = std::clamp(static_cast<int>((high.x - low.x) / pixel) + 1, 1, 1600);
    const auto rows = std::clamp(static_cast<int>((high.y - low.y) / pixel) + 1, 1, 1600);
    const double width = (high.x - low.x) / columns, height = (high.y - low.y) / rows;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const double right = low.x + (x + 0.5) * width, up = low.y + (y + 0.5) * height;
            Ray ray;
            ray.origin =
                right * axis_[0] + up * axis_[1] + (low.z - (high.z - low.z) - pixel) * axis_[2];
            ray.direction = axis_[2];
            if (!is_visible(view, ray)) continue;
            low_ = min(low_, {right - 0.5 * width, up - 0.5 * height, low.z});
            high_ = max(high_, {right + 0.5 * width, up + 0.5 * height, high.z});
        }
    }
}

CameraParams SpriteFit::camera(double aspect, double margin) const {
    if (!(low_.x < high_.x && low_.y < high_.y)) {
        throw Error(ErrorKind::Usage, "flipbook", "there is nothing to see in any frame",
                    "take other --frames, or a scene with a fluid that scatters, absorbs or glows");
    }
    const Vec3d size = high_ - low_, middle = 0.5 * (low_ + high_);
    const double height = std::max(size.y, size.x / aspect) / (1 - 2 * margin);
    // Far enough in front of everything.
    const double before = low_.z - 0.5 * (size.z + height);
    return orthographic(middle.x * axis_[0] + middle.y * axis_[1] + before * axis_[2], axis_[2],
                        axis_[1], height);
}

View unlit(const View& view) {
    View dark = view;
    dark.lights.clear();
    dark.surfaces = {};
    dark.background.reset();
    return dark;
}

View lit_from(const View& view, const Vec3d& towards) {
    View lit = unlit(view);
    SunParams sun;
    sun.direction = Keyed<Vec3d>(towards);
    sun.irradiance = 1.0;
    lit.lights = LightRig({sun}, {0, 0, 1}, {}).at(0);
    return lit;
}

std::array<Vec3d, 6> light_directions(const Camera& camera) {
    const Vec3d &right = camera.right(), &up = camera.up(), &forward = camera.forward();
    return {right, up, forward, -right, -up, -forward};
}

namespace {

// A short piece of a ray inside a medium, seen as one point.
struct RayPiece {
    double t = 0;
    float optical_depth = 0;
    std::size_t medium = 0;
};

class MotionTracer {
  public:
    MotionTracer(const View& view, int frames) : view_(view), frames_(frames) {
        for (std::size_t i = 0; i < view.media.size(); ++i) {
            const Field* velocity =
                i < view.frames.size() ? view.frames[i]->find("velocity") : nullptr;
            velocity_.push_back(velocity && velocity->is_vector() ? velocity : nullptr);
        }
    }

    struct Sum {
        float opacity = 0, depth = 0;
        Vec2f motion;
    };

    void operator()(const Ray& ray, Sum& sum) {
        pieces_.clear();
        for (std::size_t m = 0; m < view_.media.size(); ++m) cut(ray, m);
        std::ranges::sort(pieces_, {}, &RayPiece::t);
        float through = 1;
        for (const RayPiece& piece : pieces_) {
            const float after = through * std::exp(-piece.optical_depth);
            const float share = through - after;
            through = after;
            sum.opacity += share;
            sum.depth += share * static_cast<float>(view_.camera.depth(ray, piece.t));
            const Vec2f motion = motion_at(ray.at(piece.t), piece.medium);
            sum.motion.x += share * motion.x;
            sum.motion.y += share * motion.y;
            if (through < 1e-3f) break;  // of what is hidden, nothing is seen at 8 bits
        }
    }

  private:
    // Pieces of at most an optical depth of 0.1, at least two to a segment of four voxels.
    void cut(const Ray& ray, std::size_t index) {
        const Medium& medium = *view_.media[index];
        if (!medium.has_lattice()) return;
        SegmentWalk walk = medium.segments(ray);
        for (MediumSegment s; walk.next(s);) {
            const double length = s.t1 - s.t0;
            if (!(s.max > 0) || !(length > 0)) continue;
            const double wanted = std::ceil(static_cast<double>(s.mean) * length / 0.1);
            const int count = static_cast<int>(std::clamp(wanted, 2.0, 256.0));
            for (int i = 0; i < count; ++i) {
                const double t = s.t0 + (i + 0.5) * length / count;
                const float density = medium.density_at(s, static_cast<float>(t - s.anchor));
                const float depth =
                    density * medium.strength() * static_cast<float>(length / count);
                if (depth > 0) pieces_.push_back({t, depth, index});
            }
        }
    }
    Vec2f motion_at(const Vec3d& point, std::size_t medium) const {
        const Field* field = velocity_[medium];
        if (!field || !view_.around) return {};
        Vec3d velocity;
        for (int a = 0; a < 3; ++a) velocity[a] = static_cast<double>(field->sample(point, a));
        const Vec3d half = 0.5 * view_.around->interval * velocity;
        const Vec2f one = picture_motion(*view_.around, point - half, point + half);
        return {static_cast<float>(frames_) * one.x, static_cast<float>(frames_) * one.y};
    }

    const View& view_;
    int frames_;
    std::vector<const Field*> velocity_;  // of the media; null where it is unknown
    std::vector<RayPiece> pieces_;
};

}  // namespace

Image trace_motion(const View& view, int frames, Job& job) {
    const PhaseTimer timer(job, "motion");
    constexpr std::array<std::string_view, 4> channels{"A", "Z", "motion.X", "motion.Y"};
    Image image(view.width(), view.height(), channels);
    const auto opacity = image.channel("A"), depth = image.channel("Z"),
               motion_x = image.channel("motion.X"), motion_y = image.channel("motion.Y");
    parallel_ranges(view.height(), 1, [&](int begin, int end) {
        job.check();
        MotionTracer trace(view, frames);
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < view.width(); ++x) {
                MotionTracer::Sum sum;
                for (const double dy : {0.25, 0.75}) {
                    for (const double dx : {0.25, 0.75}) {
                        trace(view.camera.ray(x + dx, y + dy), sum);
                    }
                }
                const std::size_t i = image.index(x, y);
                opacity[i] = 0.25f * sum.opacity;
                depth[i] = 0.25f * sum.depth;
                motion_x[i] = 0.25f * sum.motion.x;
                motion_y[i] = 0.25f * sum.motion.y;
            }
        }
    });
    return image;
}

}  // namespace gischt
