// SPDX-License-Identifier: Apache-2.0
#include "io/ply.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

Particles some_particles(bool has_looks) {
    Particles p;
    if (has_looks) {
        p.color.resize(1);
        p.opacity.resize(1);
        p.temperature.resize(1);
    }
    p.resize(30);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const std::uint64_t key = random_key(4, i);
        const auto u = [&](std::uint32_t d) { return random_uniform(key, d); };
        p.position[i] = {1e6 + static_cast<double>(u(0)) / 3, -static_cast<double>(u(1)), 1e-9};
        p.velocity[i] = {u(2), -u(3), 1e10f};
        p.age[i] = u(4);
        p.life[i] = 2 * u(5);
        p.radius[i] = u(6) / 100;
        p.id[i] = (std::uint64_t{5} << 40) + i;
        if (!has_looks) continue;
        p.color[i] = {u(7), u(8), u(9)};
        p.opacity[i] = u(10);
        p.temperature[i] = 1000 * u(11);
    }
    return p;
}

TEST(PlyParticles, ReadsEveryBitThatItWrote) {
    const TestFolder folder("ply_particles");
    for (const bool has_looks : {false, true}) {
        const Particles p = some_particles(has_looks);
        write_ply_particles(folder.file("a.ply"), p);
        EXPECT_EQ(read_ply_particles(folder.file("a.ply")), p);
    }
    write_ply_particles(folder.file("none.ply"), {});
    EXPECT_EQ(read_ply_particles(folder.file("none.ply")), Particles{});
}

TEST(PlyParticles, ReadsThoseOfOthers) {
    const TestFolder folder("ply_particles_foreign");
    put(folder.file("a.ply"),
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property float pscale\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n1 2 3 255 0 0 0.5\n4 5 6 0 0 0 0.25\n3 0 1 0\n");
    const Particles p = read_ply_particles(folder.file("a.ply"));
    ASSERT_EQ(p.size(), 2u);
    EXPECT_EQ(p.position[1], Vec3d(4, 5, 6));
    EXPECT_EQ(p.radius[1], 0.25f);
    EXPECT_EQ(p.id[1], 1u);
    EXPECT_TRUE(p.color.empty());
    EXPECT_TRUE(std::isinf(p.life[0]));
}

TEST(PlyParticles, RefusesBrokenFiles) {
    const TestFolder folder("ply_particles_broken");
    const std::string path = folder.file("a.ply");
    write_ply_particles(path, some_particles(true));
    for_broken_files(path, read_bytes(path), [](const std::string& file, bool must_fail) {
        const Outcome o = outcome([&] { read_ply_particles(file); });
        EXPECT_TRUE(o == Outcome::Input || (o == Outcome::Fine && !must_fail));
    });
    EXPECT_TRUE(refuses_what_is_no_file(folder, read_ply_particles));
}

}  // namespace
}  // namespace gischt
