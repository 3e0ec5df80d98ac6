// SPDX-License-Identifier: Apache-2.0
#include "render/photon/photon_tree.h"

#include <gtest/gtest.h>

#include <set>

#include "base/parallel.h"
#include "base/random.h"

namespace gischt {
namespace {

Vec3f random_point(std::uint64_t key) {
    return {random_uniform(key, 0) - 0.5f, random_uniform(key, 1) - 0.5f,
            random_uniform(key, 2) - 0.5f};
}

// Some in a lump, the others all over the cube.
std::vector<Photon> scatter_photons(int n) {
    std::vector<Photon> all(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3f p = random_point(random_key(1, i));
        all[i].position = i % 3 ? p : 0.05f * p;
        all[i].place = static_cast<int>(i);
    }
    return all;
}

TEST(PhotonTree, FindsTheNearestOnes) {
    for (const int n : {1, 7, 8, 9, 1000, 5003}) {
        const PhotonTree tree(scatter_photons(n));
        ASSERT_EQ(tree.size(), static_cast<std::size_t>(n));
        std::vector<PhotonTree::Near> found;
        for (std::uint64_t q = 0; q < 50; ++q) {
            const Vec3f point = random_point(random_key(2, q));
            std::vector<float> all;
            for (std::uint32_t i = 0; i < tree.size(); ++i) {
                const Vec3f d = tree.photon(i).position - point;
                all.push_back(dot(d, d));
            }
            std::sort(all.begin(), all.end());
            tree.nearest(point, 20, 0.2f, found);
            std::sort_heap(found.begin(), found.end());
            std::size_t expected = 0;
            while (expected < std::min(all.size(), std::size_t{20}) && all[expected] < 0.2f)
                ++expected;
            ASSERT_EQ(found.size(), expected);
            for (std::size_t i = 0; i < expected; ++i) {
                EXPECT_NEAR(found[i].distance2, all[i], 1e-6f);
            }
        }
    }
}

TEST(PhotonTree, FindsTheBallsAlongARay) {
    PhotonTree tree(scatter_photons(3001));
    for (const bool is_fixed : {true, false}) {
        if (is_fixed) {
            tree.set_radius(0.03f);
        } else {
            tree.set_radius_by_nearest(10, 1, 0.2f);
        }
        std::size_t hits = 0;
        for (std::uint64_t q = 0; q < 200; ++q) {
            const Vec3f origin = random_point(random_key(3, q));
            Vec3f direction = normalize(random_point(random_key(4, q)));
            if (q % 4 == 0) direction = {0, q % 8 ? 1.0f : -1.0f, 0};
            std::set<std::uint32_t> expected, found;
            for (std::uint32_t i = 0; i < tree.size(); ++i) {
                const Vec3f d = tree.photon(i).position - origin;
                const float t = dot(d, direction);
                const Vec3f away = d - t * direction;
                if (t >= 0.1f && t <= 0.6f && length(away) < tree.radius(i)) expected.insert(i);
            }
            tree.along(origin, direction, 0.1f, 0.6f,
                       [&](std::uint32_t i, float t, float distance2, float radius2) {
                           EXPECT_TRUE(found.insert(i).second);
                           const Vec3f away = tree.photon(i).position - origin - t * direction;
                           EXPECT_NEAR(distance2, dot(away, away), 1e-6f);
                           EXPECT_NEAR(radius2, tree.radius(i) * tree.radius(i), 1e-6f);
                       });
            EXPECT_EQ(found, expected) << q;
            hits += found.size();
        }
        EXPECT_GT(hits, 200u);
    }
}

TEST(PhotonTree, IsTheSameOnAnyNumberOfThreads) {
    const auto order = [](int threads) {
        const ThreadLimit limit(threads);
        PhotonTree tree(scatter_photons(20'000));
        tree.set_radius_by_nearest(12, 0.5f, 0.2f);
        std::vector<float> all;
        for (std::uint32_t i = 0; i < tree.size(); ++i) {
            all.push_back(static_cast<float>(tree.photon(i).place));
            all.push_back(tree.radius(i));
        }
        return all;
    };
    EXPECT_EQ(order(1), order(2));
}

// Around even photons the radius of k of them holds k: 4/3 pi r^3 n = k.
TEST(PhotonTree, RadiusFollowsTheDensity) {
    std::vector<Photon> all(40'000);
    for (std::size_t i = 0; i < all.size(); ++i) all[i].position = random_point(random_key(5, i));
    PhotonTree tree(std::move(all));
    tree.set_radius_by_nearest(30, 1, 1);
    double sum = 0, count = 0;
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
        const Vec3f p = tree.photon(i).position;
        if (max_component(abs(p)) > 0.4f) continue;
        sum += std::pow(static_cast<double>(tree.radius(i)), 3);
        ++count;
    }
    EXPECT_NEAR(4.0 / 3 * 3.14159265 * sum / count * 40'000, 30, 1.5);
}

}  // namespace
}  // namespace gischt
