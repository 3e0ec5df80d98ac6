// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "io/test_files.h"

namespace gischt {
namespace {

// The cube of edge 1 as a file of each format.
std::string cube_obj() {
    const Mesh cube = cube_mesh();
    std::string text = "# a cube\n";
    for (const Vec3f& p : cube.points) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    text += "vt 0 0\nvt 1 0\nvt 1 1\n";
    for (const Vec3i& t : cube.triangles) {
        text += fmt::format("f {}/1 {}/2 {}/3\n", t.x + 1, t.y + 1, t.z + 1);
    }
    return text;
}

std::string cube_ply(bool is_binary) {
    const Mesh cube = cube_mesh();
    std::string text = fmt::format(
        "ply\nformat {} 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n",
        is_binary ? "binary_little_endian" : "ascii");
    const auto put_bytes = [&](const auto& value) {
        text.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    for (const Vec3f& p : cube.points) {
        if (is_binary) {
            put_bytes(p);
        } else {
            text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
        }
    }
    for (const Vec3i& t : cube.triangles) {
        if (is_binary) {
            text += '\3';
            put_bytes(t);
        } else {
            text += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
        }
    }
    return text;
}

// Two cubes: the second one moved by 5 along x and twice as large, by its node.
std::string cubes_glb() {
    const Mesh cube = cube_mesh();
    std::string binary;
    for (const Vec3f& p : cube.points) {
        binary.append(reinterpret_cast<const char*>(&p), sizeof(p));
    }
    for (const Vec3i& t : cube.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::uint16_t>(t[k]);
            binary.append(reinterpret_cast<const char*>(&i), sizeof(i));
        }
    }
    std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],)"
        R"("nodes":[{"mesh":0},{"mesh":0,"translation":[5,0,0],"scale":[2,2,2]}],)"
        R"("materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1]}}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)"
        R"("min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]},)"
        R"({"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],)"
        R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},)"
        R"({"buffer":0,"byteOffset":96,"byteLength":72}],"buffers":[{"byteLength":168}]})";
    while (json.size() % 4) json += ' ';
    std::string out = "glTF";
    const auto word = [&](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        out.append(reinterpret_cast<const char*>(&v), sizeof(v));
    };
    word(2);
    word(12 + 8 + json.size() + 8 + binary.size());
    word(json.size());
    out += "JSON" + json;
    word(binary.size());
    out += std::string("BIN\0", 4) + binary;
    return out;
}

TEST(MeshFile, EachFormatHoldsTheCube) {
    const TestFolder folder("mesh");
    Job job;
    put(folder.file("a.obj"), cube_obj());
    put(folder.file("b.ply"), cube_ply(false));
    put(folder.file("c.PLY"), cube_ply(true));
    for (const char* name : {"a.obj", "b.ply", "c.PLY"}) {
        const Mesh mesh = read_mesh(folder.file(name), job).mesh;
        EXPECT_EQ(mesh.triangles.size(), 12u) << name;
        EXPECT_TRUE(is_closed(mesh)) << name;
        EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-6) << name;
    }
    const Mesh obj = read_mesh(folder.file("a.obj"), job).mesh;
    ASSERT_EQ(obj.uvs.size(), obj.points.size());
    const Vec3i& t = obj.triangles[0];
    EXPECT_EQ(obj.uvs[std::size_t(t.z)], (Vec2f{1, 1}));
}

TEST(MeshFile, NodesPlaceTheirPartsAndNameAColor) {
    const TestFolder folder("mesh");
    put(folder.file("a.glb"), cubes_glb());
    Job job;
    std::string told;
    job.on_message = [&](Job::Level, std::string_view text) { told += text; };
    const MeshFile file = read_mesh(folder.file("a.glb"), job);
    EXPECT_EQ(file.mesh.triangles.size(), 24u);
    EXPECT_NEAR(enclosed_volume(file.mesh), 1 + 8, 1e-5);
    EXPECT_EQ(bounds(file.mesh).hi.x, 6);
    ASSERT_TRUE(file.base_color);
    EXPECT_NEAR(file.base_color->y, 0.5, 1e-6);
    EXPECT_EQ(told, "");
}

TEST(MeshFile, PolygonsBecomeTriangles) {
    const TestFolder folder("mesh");
    Job job;
    put(folder.file("a.obj"),
        "v 0 0 0\nv 1 0 0\nv 1.5 1 0\nv 0.5 2 0\nv -0.5 1 0\n"
        "f 1 2 3 4 5\nl 1 2\n");
    const Mesh mesh = read_mesh(folder.file("a.obj"), job).mesh;
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_NEAR(surface_area(mesh), 2.5, 1e-6);
}

TEST(MeshFile, ObjSharesPointsAndNamesAColor) {
    const TestFolder folder("mesh");
    put(folder.file("a b.mtl"),
        "newmtl plain\nNs 3\nnewmtl red brick\nKd 0.5 0.25 0.125\nmap_Kd -s 1 1 1 wall.png\n");
    const std::string head =
        "mtllib a b.mtl\nusemtl plain\nv 0 0 0\nv 1 0 0 # right\nv 1 1 0 1\nv +0 1e0 \\\n0\r\n"
        "vn 0 0 2\ns off\nf 1//1 2//1 -2//1\nusemtl red brick\n";
    put(folder.file("a.obj"), head + "f 1//1 3//1 4//-1\n");
    Job job;
    const MeshFile file = read_mesh(folder.file("a.obj"), job);
    EXPECT_EQ(file.mesh.points.size(), 4u);
    EXPECT_EQ(file.mesh.triangles, (std::vector<Vec3i>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(file.mesh.normals, std::vector<Vec3f>(4, {0, 0, 1}));
    EXPECT_TRUE(file.mesh.uvs.empty());
    EXPECT_EQ(file.base_color, (Vec3f{0.5f, 0.25f, 0.125f}));
    EXPECT_EQ(file.base_color_file, folder.file("wall.png"));
    for (const char* bad : {"f 1 2", "f 1 2 0", "f 1 2 -5", "f 1/1 2 3", "f 1/1/1/1 2 3", "v 1 2",
                            "v 1 2 nan", "v 1 2 1e99", "f 1 2 3x", "f 1 2 99999999999999999999"}) {
        put(folder.file("b.obj"), head + bad);
        EXPECT_EQ(outcome([&] { read_mesh(folder.file("b.obj"), job); }), Outcome::Input) << bad;
    }
    // A library that is missing or broken costs the colour only.
    std::string told;
    job.on_message = [&](Job::Level, std::string_view text) { told += text; };
    put(folder.file("a b.mtl"), "newmtl red brick\nKd x\n");
    EXPECT_FALSE(read_mesh(folder.file("a.obj"), job).base_color);
    EXPECT_NE(told.find("a b.mtl"), std::string::npos) << told;
}

// Velocities and normals of points, other elements and properties passed over, both orders of
// bytes.
TEST(MeshFile, PlyHoldsVelocities) {
    const TestFolder folder("mesh");
    Job job;
    put(folder.file("a.ply"),
        "ply\r\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty double x\n"
        "property float y\nproperty int z\nproperty uchar red\nproperty float vx\n"
        "property float vy\nproperty float vz\nelement edge 1\nproperty list uchar int ends\n"
        "element face 1\nproperty float area\nproperty list uchar uint vertex_index\nend_header\n"
        "0 0 0 255 1 2 3\n1 0 0 0 4 5 6\n0 1 0 7 7 8 9\n2 0 1\n0.5 3 0 1 2\n");
    const Mesh mesh = read_mesh(folder.file("a.ply"), job).mesh;
    ASSERT_EQ(mesh.velocities.size(), 3u);
    EXPECT_EQ(mesh.velocities[1], Vec3f(4, 5, 6));
    EXPECT_EQ(mesh.triangles[0], Vec3i(0, 1, 2));
    std::string big =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\n"
        "property short y\nproperty short z\nelement face 1\n"
        "property list uchar ushort vertex_indices\nend_header\n";
    big += std::string("\0\0\0\0\0\0\1\0\0\0\0\0\0\0\0\2\0\0\3\0\0\0\1\0\2", 25);
    put(folder.file("b.ply"), big);
    const Mesh other = read_mesh(folder.file("b.ply"), job).mesh;
    EXPECT_EQ(other.points[1], Vec3f(256, 0, 0));
    EXPECT_EQ(other.points[2], Vec3f(0, 2, 0));
    // An element that claims more than the file holds is refused before it fills the memory.
    put(folder.file("c.ply"),
        "ply\nformat ascii 1.0\nelement vertex 99999999999\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n");
    EXPECT_EQ(outcome([&] { read_mesh(folder.file("c.ply"), job); }), Outcome::Input);
}

TEST(MeshFile, RefusesWhatIsNoMesh) {
    const TestFolder folder("mesh");
    Job job;
    const auto read = [&](const std::string& path) { read_mesh(path, job); };
    EXPECT_TRUE(refuses_what_is_no_file(folder, read));
    for (const std::string& extension : mesh_extensions()) {
        put(folder.file("empty" + extension), "");
        EXPECT_EQ(outcome([&] { read(folder.file("empty" + extension)); }), Outcome::Input);
        EXPECT_EQ(outcome([&] { read(folder.file("no" + extension)); }), Outcome::Input);
    }
    put(folder.file("a.txt"), "v 0 0 0\n");
    EXPECT_EQ(outcome([&] { read(folder.file("a.txt")); }), Outcome::Usage);
    put(folder.file("points.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    EXPECT_EQ(outcome([&] { read(folder.file("points.obj")); }), Outcome::Input);
    // An index of a point that is not there.
    put(folder.file("index.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    EXPECT_EQ(outcome([&] { read(folder.file("index.obj")); }), Outcome::Input);
}

// Whatever becomes of a file: it is read or refused, and what is read has no index out of range
// once faults are removed.
TEST(MeshFile, BrokenFilesAreReadOrRefused) {
    const TestFolder folder("mesh");
    Job job;
    const auto check = [&](const std::string& path) {
        const Outcome o = outcome([&] {
            Mesh mesh = read_mesh(path, job).mesh;
            remove_faults(mesh);
            for (const Vec3i& t : mesh.triangles) {
                for (int k = 0; k < 3; ++k) {
                    ASSERT_LT(static_cast<std::size_t>(t[k]), mesh.points.size());
                }
            }
        });
        ASSERT_TRUE(o == Outcome::Fine || o == Outcome::Input || o == Outcome::Resource);
    };
    const std::string cases[][2] = {{"a.obj", cube_obj()},
                                    {"b.ply", cube_ply(false)},
                                    {"c.ply", cube_ply(true)},
                                    {"d.glb", cubes_glb()}};
    for (const auto& [name, bytes] : cases) {
        for_broken_files(folder.file(name), bytes,
                         [&](const std::string& path, bool) { check(path); });
    }
}

}  // namespace
}  // namespace gischt
