// SPDX-License-Identifier: Apache-2.0
#include "render/march/sky_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "base/parallel.h"
#include "image/color.h"

namespace gischt {
namespace {

constexpr int finest = 8;  // log2 of the texels along a face: 0.35 degrees each

// Light in a square of a face of the cube.
struct Patch {
    Vec3d flux;      // integral of radiance over the solid angle
    Vec3d centroid;  // integral of direction times (luminance + a little)
    Vec3d middle;    // integral of direction
    double solid_angle = 0;

    void add(const Patch& b) {
        flux += b.flux;
        centroid += b.centroid;
        middle += b.middle;
        solid_angle += b.solid_angle;
    }
};

struct Place {
    int face, level, x, y;  // level 0 is the whole face
};

// The direction at (u, v) in [-1,1]^2 of a face. Angles are equidistant, so that all texels are
// seen nearly equally large.
Vec3d direction_of(int face, double u, double v) {
    const int axis = face / 2;
    Vec3d d;
    d[axis] = face % 2 ? -1 : 1;
    d[(axis + 1) % 3] = std::tan(0.25 * pi * u);
    d[(axis + 2) % 3] = std::tan(0.25 * pi * v);
    return normalize(d);
}

// Solid angle of a texel from the density of the map, relative; the sum is normalised later.
double density_of(double u, double v) {
    const double a = std::tan(0.25 * pi * u), b = std::tan(0.25 * pi * v);
    return (1 + a * a) * (1 + b * b) / std::pow(1 + a * a + b * b, 1.5);
}

class Pyramid {
  public:
    explicit Pyramid(std::span<const Light* const> lights) {
        for (int level = 0; level <= finest; ++level) {
            levels_.emplace_back(std::size_t{6} << (2 * level));
        }
        fill(lights);
        for (int level = finest - 1; level >= 0; --level) reduce(level);
    }
    const Patch& at(const Place& p) const {
        return levels_[static_cast<std::size_t>(p.level)][index(p)];
    }

  private:
    static std::size_t index(const Place& p) {
        const auto n = std::size_t{1} << p.level;
        return (static_cast<std::size_t>(p.face) * n + static_cast<std::size_t>(p.y)) * n +
               static_cast<std::size_t>(p.x);
    }

    void fill(std::span<const Light* const> lights) {
        constexpr int n = 1 << finest;
        const double cell = 2.0 / n;
        double total = 0;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                total += 6 * density_of((x + 0.5) * cell - 1, (y + 0.5) * cell - 1);
            }
        }
        parallel_for(6 * n, 4, [&](int row) {
            const int face = row / n, y = row % n;
            for (int x = 0; x < n; ++x) {
                const double u = (x + 0.5) * cell - 1, v = (y + 0.5) * cell - 1;
                const Vec3d d = direction_of(face, u, v);
                Vec3f radiance;
                for (const Light* light : lights) radiance += light->radiance(d);
                Patch& p = levels_[finest][index({face, finest, x, y})];
                p.solid_angle = 4 * pi * density_of(u, v) / total;
                p.flux = p.solid_angle * Vec3d(radiance);
                p.middle = p.solid_angle * d;
                // The little is for dark parts, whose centre is their middle.
                p.centroid = (static_cast<double>(luminance(radiance)) + 1e-9) * p.middle;
            }
        });
    }

    void reduce(int level) {
        const int n = 1 << level;
        for (int face = 0; face < 6; ++face) {
            for (int i = 0; i < n * n; ++i) {
                const int x = i % n, y = i / n;
                Patch& p = levels_[static_cast<std::size_t>(level)][index({face, level, x, y})];
                for (int c = 0; c < 4; ++c) {
                    p.add(at({face, level + 1, 2 * x + c % 2, 2 * y + c / 2}));
                }
            }
        }
    }

    std::vector<std::vector<Patch>> levels_;
};

SkyDirection as_direction(const Patch& p) {
    SkyDirection d;
    d.direction = normalize(p.centroid);
    d.solid_angle = static_cast<float>(p.solid_angle);
    d.radiance = Vec3f(p.flux / Vec3d(p.solid_angle));
    d.mean_cosine = static_cast<float>(length(p.middle) / p.solid_angle);
    return d;
}

// How much light a part may bring to the viewer: its flux times the largest phase function, of
// which a share counts as isotropic, as light that shines through is shadowed from everywhere.
double share_of(const Patch& p, const PhaseFunction& phase, std::span<const Vec3d> forward) {
    const Vec3d d = normalize(p.centroid);
    float lobe = static_cast<float>(0.25 / pi);
    for (const Vec3d& f : forward) {
        lobe = std::max(lobe, value(phase, static_cast<float>(dot(d, f))));
    }
    return luminance(p.flux) * static_cast<double>(lobe);
}

}  // namespace

std::vector<SkyDirection> sky_directions(std::span<const Light* const> lights,
                                         const PhaseFunction& phase, std::span<const Vec3d> forward,
                                         int count) {
    const Pyramid pyramid(lights);
    struct Entry {
        double share;
        Place place;
    };
    const auto less = [](const Entry& a, const Entry& b) { return a.share < b.share; };
    std::priority_queue<Entry, std::vector<Entry>, decltype(less)> queue(less);
    std::vector<SkyDirection> out;
    const auto push = [&](const Place& place) {
        if (place.level == finest) {
            out.push_back(as_direction(pyramid.at(place)));
        } else {
            queue.push({share_of(pyramid.at(place), phase, forward), place});
        }
    };
    for (int face = 0; face < 6; ++face) {
        for (int c = 0; c < 4; ++c) push({face, 1, c % 2, c / 2});
    }
    while (!queue.empty() && static_cast<int>(queue.size() + out.size()) + 3 <= count) {
        const Place p = queue.top().place;
        queue.pop();
        for (int c = 0; c < 4; ++c) {
            push({p.face, p.level + 1, 2 * p.x + c % 2, 2 * p.y + c / 2});
        }
    }
    for (; !queue.empty(); queue.pop()) {
        out.push_back(as_direction(pyramid.at(queue.top().place)));
    }
    return out;
}

}  // namespace gischt
