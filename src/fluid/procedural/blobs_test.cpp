// SPDX-License-Identifier: Apache-2.0
#include "fluid/procedural/blobs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"

namespace gischt {
namespace {

constexpr BlobKernel every_kernel[] = {BlobKernel::Wyvill, BlobKernel::Blinn, BlobKernel::Metaball,
                                       BlobKernel::Murakami};

BlobParams ball(const Vec3d& position, double radius) {
    BlobParams b;
    b.position = position;
    b.radius = radius;
    return b;
}

double field_at(const Blobs& blobs, const Vec3d& p) {
    const std::vector<int> near = blobs.near(p, 0);
    return blobs.at(near, p).field;
}

TEST(BlobKernel, IsOneHalfAtTheRadiusAndFallsToZeroAtItsSupport) {
    for (const BlobKernel k : every_kernel) {
        for (const double b : {0.5, 2.0}) {
            EXPECT_NEAR(blob_field(k, 1, b), blob_surface, 1e-12);
            EXPECT_NEAR(blob_field(k, 0, b), k == BlobKernel::Blinn ? 0.5 * std::exp(b) : 1, 1e-12);
            const double support = blob_support(k, b);
            EXPECT_LT(blob_field(k, 0.9999 * support, b), 1e-6);
            EXPECT_EQ(blob_field(k, support, b), 0);
            double last = blob_field(k, 0, b);
            for (int i = 1; i < 1000; ++i) {
                const double rho = i * 0.001 * support, f = blob_field(k, rho, b);
                ASSERT_LT(f, last);
                ASSERT_NEAR(blob_distance(k, f, b), rho, 1e-4 * support);
                last = f;
            }
        }
    }
}

// No kink anywhere: slopes from the left and the right agree, in the middle and at the joints too.
TEST(BlobKernel, HasAContinuousSlope) {
    constexpr double e = 1e-5;
    for (const BlobKernel k : every_kernel) {
        const double support = blob_support(k, 0.7);
        for (int i = 0; i <= 300; ++i) {
            const double rho = i / 300.0 * support;
            const auto f = [&](double r) { return blob_field(k, std::abs(r), 0.7); };
            const double before = (f(rho) - f(rho - e)) / e, after = (f(rho + e) - f(rho)) / e;
            // Second derivatives are below 6; the end of a Gaussian is a step of 2^-21.
            ASSERT_NEAR(before, after, k == BlobKernel::Blinn ? 0.05 : 1e-4) << i;
        }
    }
}

TEST(Blobs, ABlobAloneIsABallOfItsRadius) {
    for (const BlobKernel k : every_kernel) {
        const Blobs one({ball({1, 2, 3}, 0.7)}, k, 0.7, 0);
        for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(0, -1, 0), Vec3d(0.6, 0, 0.8)}) {
            EXPECT_NEAR(field_at(one, Vec3d(1, 2, 3) + 0.7 * d), blob_surface, 1e-12);
        }
    }
}

TEST(Blobs, FarOnesDoNotInteractAndNearOnesMelt) {
    for (const BlobKernel k : every_kernel) {
        const double far = 1.0 + blob_support(k, 0.7);
        const Blobs one({ball({}, 1)}, k, 0.7, 0);
        const Blobs apart({ball({}, 1), ball({far + 0.01, 0, 0}, 1)}, k, 0.7, 0);
        for (const double x : {0.2, 0.7, 1.0}) {
            EXPECT_EQ(field_at(one, {x, 0, 0}), field_at(apart, {x, 0, 0}));
        }
        // Between two that leave a gap of a tenth there is fluid, and as much on both sides.
        const Blobs two({ball({-1.05, 0, 0}, 1), ball({1.05, 0, 0}, 1)}, k, 0.7, 0);
        EXPECT_GT(field_at(two, {}), blob_surface);
        EXPECT_NEAR(field_at(two, {0.4, 0.3, 0}), field_at(two, {-0.4, -0.3, 0}), 1e-14);
    }
}

// Across the bridge between two balls the surface is smooth: the gradient is continuous.
TEST(Blobs, MeltWithoutAKink) {
    constexpr double e = 1e-5;
    for (const BlobKernel k : every_kernel) {
        if (k == BlobKernel::Blinn) continue;  // has the step at its end that is stated
        const Blobs two({ball({-1.05, 0, 0}, 1), ball({1.05, 0, 0}, 0.8)}, k, 0.7, 0);
        for (int i = -300; i <= 300; ++i) {
            const double x = 0.01 * i;
            const double a = field_at(two, {x - e, 0.4, 0}), b = field_at(two, {x, 0.4, 0}),
                         c = field_at(two, {x + e, 0.4, 0});
            ASSERT_NEAR((b - a) / e, (c - b) / e, 4e-4) << x;
        }
    }
}

TEST(Blobs, ACurveIsAHoseOfItsRadii) {
    BlobParams hose = ball({0, 0, 1}, 0.5);
    hose.points = {{-2, 0, 0}, {0, 0, 0}, {2, 0, 0}};
    hose.radii = {1, 1, 2};
    for (const BlobCurve curve : {BlobCurve::Polyline, BlobCurve::CatmullRom}) {
        hose.curve = curve;
        const Blobs blobs({hose}, BlobKernel::Wyvill, 1, 0);
        EXPECT_NEAR(field_at(blobs, {-1, 0.5, 1}), blob_surface, 1e-9);
        EXPECT_NEAR(field_at(blobs, {-1, 0, 0.5}), blob_surface, 1e-9);
        EXPECT_NEAR(field_at(blobs, {2, 1, 1}), blob_surface, 1e-9);
        EXPECT_NEAR(field_at(blobs, {-2.5, 0, 1}), blob_surface, 1e-9);
    }
}

TEST(Blobs, ASmoothCurvePassesThroughItsPoints) {
    BlobParams hose = ball({}, 0.1);
    hose.points = {{0, 0, 0}, {1, 1, 0}, {2, 0, 1}, {3, 1, 0}};
    const Blobs blobs({hose}, BlobKernel::Murakami, 1, 0);
    for (const Vec3d& p : hose.points) EXPECT_NEAR(field_at(blobs, p), 1, 1e-9);
}

TEST(Blobs, MoveWithTheirKeyframes) {
    BlobParams b = ball({}, 1);
    b.position = Keyed<Vec3d>({0, 2}, {Vec3d(0, 0, 0), Vec3d(4, 0, -2)});
    const Blobs later({b}, BlobKernel::Wyvill, 1, 1);
    EXPECT_NEAR(field_at(later, {2, 0, 0}), blob_surface, 1e-12);
    const std::vector<int> near = later.near({2, 0, -1}, 0);
    EXPECT_LT(length(later.at(near, {2, 0, -1}).drift - Vec3d(2, 0, -1)), 1e-9);
}

TEST(Blobs, RefusesARadiusThatVanishes) {
    BlobParams b = ball({}, 1);
    b.radius = Keyed<double>({0, 1}, {1, -1});
    EXPECT_NO_THROW(Blobs({b}, BlobKernel::Wyvill, 1, 0));
    EXPECT_THROW(Blobs({b}, BlobKernel::Wyvill, 1, 0.9), Error);
}

}  // namespace
}  // namespace gischt
