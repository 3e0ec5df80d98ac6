// SPDX-License-Identifier: Apache-2.0
#include "optics/emission_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "image/color.h"

namespace gischt {
namespace {

using MediumPtr = std::shared_ptr<const Medium>;

template <class F>
Field field_of(int cells, double edge, F&& f) {
    Field field;
    field.component.emplace_back(TileMap::box(Vec3i(cells)));
    field.to_world = Transform::scale_translate(edge / cells, Vec3d(-0.5 * edge));
    for (int i = 0; i < cells * cells * cells; ++i) {
        const Vec3i c(i % cells, i / cells % cells, i / cells / cells);
        field.component[0].ref(c) =
            static_cast<float>(f(field.to_world.point(Vec3d(c) + Vec3d(0.5))));
    }
    return field;
}

// A flame above its smoke, in a box of 2 m: where it burns there is no density.
MediumPtr fire() {
    Frame frame;
    frame.fields.emplace("density", field_of(40, 2, [](const Vec3d& p) {
                             return std::max(0.0, 0.6 - length(p + Vec3d(0, 0, 0.4)));
                         }));
    frame.fields.emplace("flame", field_of(40, 2, [](const Vec3d& p) {
                             return std::max(0.0, 0.4 - length(p - Vec3d(0.1, 0, 0.5)));
                         }));
    MediumParams params;
    params.emission = EmissionKind::Flame;
    params.emission_scale = Keyed<double>(1e-3);
    Job job;
    return std::make_shared<const Medium>(frame, params, 0, job);
}

MediumPtr coal(const Region& region, double kelvin) {
    MediumParams params;
    params.absorption = Keyed<Vec3d>(Vec3d(0.7));
    params.scattering = Keyed<Vec3d>(Vec3d(0));
    params.emission = EmissionKind::Blackbody;
    params.emission_scale = Keyed<double>(1e-3);
    return std::make_shared<const Medium>(region, params, 0, kelvin);
}

std::vector<MediumPtr> scene() {
    Region box = Region::box({{2, -1, -1}, {3, 0, 2}});
    box.rotation = Transform::rotation({0, 0, 1}, 0.4);
    MediumParams dark;
    return {fire(), std::make_shared<const Medium>(Region::box({Vec3d(-3), Vec3d(-2)}), dark, 0),
            coal(Region::sphere({-2, 0, 0}, 0.5), 1600), coal(box, 1500)};
}

struct Uniforms {
    std::uint64_t key;
    float operator()(std::uint32_t d) const { return random_uniform(key, d); }
    Vec3f three() const { return {(*this)(1), (*this)(2), (*this)(3)}; }
};

const Vec3d receivers[] = {{0, 0, 0.5}, {0.1, -0.3, 0.2}, {-2, 0, 0}, {30, -20, 10}, {1, 1, -1}};

// The integral of the luminance of the emission, by the midpoints of voxels an eighth as large and
// by closed forms.
double true_power(const std::vector<MediumPtr>& media) {
    double sum = 0;
    constexpr int n = 80;
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3d p = Vec3d(-1) + (2.0 / n) * (Vec3d(i % n, i / n % n, i / n / n) + Vec3d(0.5));
        sum += static_cast<double>(luminance(media[0]->at(p).emission)) * std::pow(2.0 / n, 3);
    }
    sum += static_cast<double>(luminance(media[2]->at({-2, 0, 0}).emission)) * 4 * pi / 3 * 0.125;
    sum += static_cast<double>(luminance(media[3]->at({2.5, -0.5, 0.5}).emission)) * 3;
    return sum;
}

// E[emission / pdf] is the integral of the emission, whoever asks: z-test at a family-wise 1e-4.
TEST(EmissionSampler, IsUnbiased) {
    const auto media = scene();
    const EmissionSampler sampler(media);
    const double truth = true_power(media);
    EXPECT_NEAR(sampler.power() / truth, 1, 0.02);
    for (const Vec3d& receiver : receivers) {
        constexpr int count = 60000;
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const Uniforms u{random_key(11, std::uint64_t(i))};
            const EmissionSample s = sampler.sample(receiver, u(0), u.three());
            ASSERT_GT(s.pdf, 0);
            ASSERT_NEAR(sampler.pdf(receiver, s.medium, s.point) / s.pdf, 1, 1e-5);
            const auto medium = static_cast<std::size_t>(s.medium);
            const double x =
                static_cast<double>(luminance(media[medium]->at(s.point).emission) / s.pdf);
            sum += x, squares += x * x;
        }
        const double mean = sum / count;
        const double error = std::sqrt((squares / count - mean * mean) / count);
        EXPECT_LT(error, 0.02 * truth);
        EXPECT_LT(std::abs(mean - truth), 4.3 * error + 2e-3 * truth);
    }
}

// Blocks come up as often as their probability says, which sums to one. 99.99 % quantile by Wilson
// & Hilferty 1931.
TEST(EmissionSampler, DrawsBlocksByTheirProbability) {
    const auto media = scene();
    const EmissionSampler sampler(media);
    ASSERT_GT(sampler.leaf_count(), 50);
    for (const Vec3d& receiver : receivers) {
        const auto n = static_cast<std::size_t>(sampler.leaf_count());
        std::vector<double> seen(n), expected(n);
        constexpr int count = 100000;
        double total = 0;
        for (std::size_t i = 0; i < n; ++i) {
            expected[i] = count * sampler.probability(receiver, static_cast<int>(i));
            total += expected[i] / count;
        }
        EXPECT_NEAR(total, 1, 1e-6);
        for (int i = 0; i < count; ++i) {
            const Uniforms u{random_key(5, std::uint64_t(i))};
            const EmissionSample s = sampler.sample(receiver, u(0), u.three());
            const int leaf = sampler.leaf_of(s.medium, s.point);
            ASSERT_GE(leaf, 0);
            seen[static_cast<std::size_t>(leaf)] += 1;
        }
        double chi2 = 0, rest_seen = 0, rest_expected = 0;
        int fields = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (expected[i] < 5) {
                rest_seen += seen[i], rest_expected += expected[i];
            } else {
                chi2 += std::pow(seen[i] - expected[i], 2) / expected[i], ++fields;
            }
        }
        if (rest_expected > 5) {
            chi2 += std::pow(rest_seen - rest_expected, 2) / rest_expected, ++fields;
        }
        const double k = fields - 1, v = 2 / (9 * k),
                     limit = k * std::pow(1 - v + 3.719 * std::sqrt(v), 3);
        EXPECT_LT(chi2, limit);
    }
}

// What emits can be drawn: the flame has no density.
TEST(EmissionSampler, ReachesEveryPointThatEmits) {
    const auto media = scene();
    const EmissionSampler sampler(media);
    int without_density = 0;
    for (int i = 0; i < 20000; ++i) {
        const Uniforms u{random_key(3, std::uint64_t(i))};
        const Vec3d p = 2.0 * Vec3d(u.three()) - Vec3d(1);
        const MediumPoint at = media[0]->at(p);
        if (max_component(at.emission) <= 0) continue;
        EXPECT_GT(sampler.pdf({9, 9, 9}, 0, p), 0);
        without_density += at.extinction() == Vec3f{};
    }
    EXPECT_GT(without_density, 100);
    EXPECT_EQ(sampler.pdf({}, 1, Vec3d(-2.5)), 0);       // dark
    EXPECT_EQ(sampler.pdf({}, 3, {2.01, -0.99, 0}), 0);  // beside the turned box
    EXPECT_EQ(sampler.pdf({}, 0, {0, 0, 1e12}), 0);
}

// The density of directions integrates to one over the sphere, also for those inside: the mean of
// 1/pdf over drawn directions is the solid angle that glows, and the density that of the draws.
TEST(EmissionSampler, DirectionsHaveTheirDensity) {
    const std::vector<MediumPtr> media{fire(), coal(Region::sphere({-2, 0, 0}, 0.5), 1600)};
    const EmissionSampler sampler(media);
    for (const Vec3d& receiver : receivers) {
        // Even directions: the mean of the density times 4 pi.
        constexpr int count = 40000;
        double sum = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
            const Uniforms u{random_key(9, std::uint64_t(i))};
            const EmissionSample s = sampler.sample(receiver, u(0), u.three());
            // Half of the directions drawn, half even, by the balance heuristic: bounded weights.
            Vec3d direction = normalize(s.point - receiver);
            if (i % 2) {
                const double z = 2 * double(u(4)) - 1, turn = 2 * pi * double(u(5));
                const double r = std::sqrt(1 - z * z);
                direction = {r * std::cos(turn), r * std::sin(turn), z};
            }
            const auto p = static_cast<double>(sampler.direction_pdf({receiver, direction}));
            const double even = 0.25 / pi;
            const double x = p / (0.5 * (p + even));
            sum += x, squares += x * x;
        }
        const double mean = sum / count;
        const double error = std::sqrt((squares / count - mean * mean) / count);
        EXPECT_LT(std::abs(mean - 1), 4.3 * error + 1e-6) << receiver.x;
    }
}

// Near blocks come first: from far away the share of a ball is that of its power, next to one of
// two equal balls almost all samples lie in that.
TEST(EmissionSampler, PrefersWhatIsNear) {
    const std::vector<MediumPtr> media{coal(Region::sphere({-2, 0, 0}, 0.5), 1500),
                                       coal(Region::sphere({2, 0, 0}, 0.5), 1500)};
    const EmissionSampler sampler(media);
    const auto share = [&](const Vec3d& receiver) {
        return sampler.probability(receiver, sampler.leaf_of(0, {-2, 0, 0}));
    };
    EXPECT_NEAR(share({0, 1e5, 0}), 0.5, 1e-6);
    EXPECT_GT(share({-2, 0, 1}), 0.9);
    EXPECT_LT(share({2, 0, 1}), 0.1);
}

TEST(EmissionSampler, IsEmptyWhereNothingGlows) {
    const EmissionSampler none;
    EXPECT_TRUE(none.is_empty());
    const std::vector<MediumPtr> media{coal(Region::sphere({}, 1), 100)};
    const EmissionSampler cold(media);
    EXPECT_TRUE(cold.is_empty());
    EXPECT_EQ(cold.sample({}, 0.5f, Vec3f(0.5f)).pdf, 0);
    EXPECT_EQ(cold.direction_pdf({{}, {0, 0, 1}}), 0);
    EXPECT_EQ(cold.pdf({}, 0, {}), 0);
}

}  // namespace
}  // namespace gischt
