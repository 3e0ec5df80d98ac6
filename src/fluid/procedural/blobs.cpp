// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/blobs.h"

#include <cmath>

#include "base/error.h"

namespace gischt {

const Table<BlobParams>& blob_table() {
    using P = BlobParams;
    static const Table<P> table =
        Table<P>("blob", "A ball, or a hose along a curve, that melts into its neighbours")
            .add("position", &P::position, {.unit = "m", .help = "Its middle"})
            .add("radius", &P::radius,
                 {.unit = "m", .help = "Where no other blob is near", .min = 0, .min_open = true})
            .add("points", &P::points,
                 {.unit = "m", .help = "From the position: a curve that it follows"})
            .add("radii", &P::radii,
                 {.help = "Share of the radius at each point; none: 1", .min = 0, .min_open = true})
            .choice("curve", &P::curve,
                    {{"polyline", BlobCurve::Polyline, "straight from point to point"},
                     {"catmull_rom", BlobCurve::CatmullRom, "smooth through the points"}},
                    {.help = "How it goes through its points"})
            .check([](const P& p, const Fail& fail) {
                if (!p.radii.empty() && p.radii.size() != p.points.size())
                    fail("radii", "must be as many as 'points'");
            });
    return table;
}

// In units of the support u = rho^2 / support^2, Wyvill's 1 - 22/9 u + 17/9 u^2 - 4/9 u^3 is
// (1 - u)^2 (1 - 4/9 u), which is 1/2 at u = 1/4.
double blob_support(BlobKernel kernel, double blobbiness) {
    switch (kernel) {
        case BlobKernel::Wyvill:
            return 2;
        case BlobKernel::Blinn:
            return std::sqrt(1 + 20 * std::log(2.0) / blobbiness);
        case BlobKernel::Metaball:
            return 1 / (1 - 1 / std::sqrt(3.0));
        case BlobKernel::Murakami:
            return 1 / std::sqrt(1 - std::sqrt(0.5));
    }
    return 0;
}

double blob_field(BlobKernel kernel, double rho, double blobbiness) {
    const double s = rho / blob_support(kernel, blobbiness), u = s * s;
    if (s >= 1) return 0;
    switch (kernel) {
        case BlobKernel::Wyvill:
            return (1 - u) * (1 - u) * (1 - 4.0 / 9 * u);
        case BlobKernel::Blinn:
            return 0.5 * std::exp(blobbiness * (1 - rho * rho));
        case BlobKernel::Metaball:
            return s < 1.0 / 3 ? 1 - 3 * u : 1.5 * (1 - s) * (1 - s);
        case BlobKernel::Murakami:
            return (1 - u) * (1 - u);
    }
    return 0;
}

double blob_distance(BlobKernel kernel, double field, double blobbiness) {
    const double support = blob_support(kernel, blobbiness);
    if (field <= 0) return support;
    if (kernel == BlobKernel::Blinn) {
        const double square = 1 - std::log(2 * field) / blobbiness;
        return std::min(support, std::sqrt(std::max(0.0, square)));
    }
    if (field >= 1) return 0;
    if (kernel == BlobKernel::Metaball) {
        const double s = field > 2.0 / 3 ? std::sqrt((1 - field) / 3) : 1 - std::sqrt(field / 1.5);
        return support * s;
    }
    if (kernel == BlobKernel::Murakami) return support * std::sqrt(1 - std::sqrt(field));
    // u = 1 - sqrt(F / (1 - 4/9 u)): the right-hand side's slope is at most 1/4 on the way, so that
    // each round adds more than half a digit.
    double u = 0.25;
    for (int i = 0; i < 16; ++i) u = std::max(0.0, 1 - std::sqrt(field / (1 - 4.0 / 9 * u)));
    return support * std::sqrt(u);
}

// Places on the curve and the radii there, `between` of them from one point to the next.
static void trace(const BlobParams& blob, std::vector<Vec3d>& places, std::vector<double>& radii) {
    const auto count = static_cast<int>(blob.points.size());
    const auto point = [&](int i) {
        // Beyond an end the curve goes on as it came: its mirror image.
        if (i < 0) return 2.0 * blob.points.front() - blob.points[1];
        if (i >= count) return 2.0 * blob.points.back() - blob.points[blob.points.size() - 2];
        return blob.points[static_cast<std::size_t>(i)];
    };
    const auto radius = [&](int i) {
        return blob.radii.empty() ? 1.0 : blob.radii[static_cast<std::size_t>(i)];
    };
    const int between = blob.curve == BlobCurve::Polyline ? 1 : 12;  // 12: bends of 90 degrees in
                                                                     // steps of less than 10
    for (int i = 0; i + 1 < count; ++i) {
        for (int k = 0; k < between; ++k) {
            const double t = static_cast<double>(k) / between;
            const Vec3d p0 = point(i - 1), p1 = point(i), p2 = point(i + 1), p3 = point(i + 2);
            // Uniform Catmull-Rom: a cubic with central differences as slopes.
            const Vec3d smooth =
                0.5 * (2.0 * p1 + t * (p2 - p0) + t * t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                       t * t * t * (3.0 * p1 - p0 - 3.0 * p2 + p3));
            places.push_back(between == 1 ? p1 : smooth);
            radii.push_back(lerp(radius(i), radius(i + 1), t));
        }
    }
    places.push_back(count ? blob.points.back() : Vec3d());
    radii.push_back(count ? radius(count - 1) : 1.0);
}

Blobs::Blobs(const std::vector<BlobParams>& blobs, BlobKernel kernel, double blobbiness,
             double time)
    : kernel_(kernel), blobbiness_(blobbiness), support_(blob_support(kernel, blobbiness)) {
    for (std::size_t n = 0; n < blobs.size(); ++n) {
        const BlobParams& blob = blobs[n];
        const Vec3d position = blob.position.at(time), drift = blob.position.rate(time);
        const double radius = blob.radius.at(time);
        std::vector<Vec3d> places;
        std::vector<double> radii;
        trace(blob, places, radii);
        for (std::size_t i = 0; i < std::max<std::size_t>(1, places.size() - 1); ++i) {
            const std::size_t next = std::min(i + 1, places.size() - 1);
            if (!(radius * std::min(radii[i], radii[next]) > 0))
                throw Error(ErrorKind::Usage, "blob", "the radius must be positive at any time");
            pieces_.push_back({position + places[i], position + places[next], radius * radii[i],
                               radius * radii[next], static_cast<int>(n), drift});
        }
    }
}

// Where on the piece, as a share of its length, a point is nearest to.
static double nearest_share(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
    const Vec3d along = b - a;
    const double square = dot(along, along);
    return square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
}

std::vector<int> Blobs::near(const Vec3d& center, double reach) const {
    std::vector<int> found;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const Piece& s = pieces_[i];
        const Vec3d nearest = lerp(s.a, s.b, nearest_share(s.a, s.b, center));
        const double far = reach + support_ * std::max(s.radius_a, s.radius_b);
        const Vec3d to = nearest - center;
        if (dot(to, to) < far * far) found.push_back(static_cast<int>(i));
    }
    return found;
}

BlobSample Blobs::at(std::span<const int> pieces, const Vec3d& p) const {
    BlobSample sum;
    for (std::size_t n = 0; n < pieces.size();) {
        // The nearest place on one blob's curve ...
        const int blob = pieces_[static_cast<std::size_t>(pieces[n])].blob;
        double rho = support_, radius = 0;
        Vec3d drift;
        for (; n < pieces.size(); ++n) {
            const Piece& s = pieces_[static_cast<std::size_t>(pieces[n])];
            if (s.blob != blob) break;
            const double share = nearest_share(s.a, s.b, p);
            const double r = lerp(s.radius_a, s.radius_b, share);
            const double d = length(p - lerp(s.a, s.b, share)) / r;
            if (d < rho) {
                rho = d;
                radius = r;
                drift = s.drift;
            }
        }
        // ... gives its field.
        const double field = blob_field(kernel_, rho, blobbiness_);
        sum.field += field;
        sum.radius += field * radius;
        sum.drift += field * drift;
    }
    if (sum.field > 0) {
        sum.radius = sum.radius / sum.field;
        sum.drift = sum.drift / sum.field;
    }
    return sum;
}

}  // namespace gischt
