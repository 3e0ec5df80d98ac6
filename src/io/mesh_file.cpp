// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_file.h"

#include <assimp/scene.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <stdexcept>
#include <string_view>

#include "base/error.h"
#include "io/file_bytes.h"
#include "io/obj.h"
#include "io/ply.h"

namespace gischt {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const std::string& path) {
    std::string e = fs::path(path).extension().string();
    for (char& c : e) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return e;
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(ErrorKind::Input, path, what);
}

void check_path(const std::string& path) {
    const auto& valid = mesh_extensions();
    const std::string extension = lower_extension(path);
    if (std::find(valid.begin(), valid.end(), extension) == valid.end()) {
        std::error_code ignored;
        if (!fs::is_regular_file(path, ignored)) refuse(path, "is no file");
        if (fs::file_size(path, ignored) == 0) refuse(path, "is empty");
        throw Error(ErrorKind::Usage, path,
                    extension.empty() ? "has no extension that names a mesh format"
                                      : fmt::format("'{}' is no mesh format", extension),
                    fmt::format("valid: {}", fmt::join(valid, ", ")));
    }
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) refuse(path, "is no file");
    if (fs::file_size(path, ignored) == 0) refuse(path, "is empty");
}

// A file in memory for Assimp. Some of its readers try again and again at the end of a file that
// was cut off: this ends it.
class MemoryStream : public Assimp::IOStream {
  public:
    explicit MemoryStream(std::string bytes) : bytes_(std::move(bytes)) {}

    std::size_t Read(void* out, std::size_t size, std::size_t count) override {
        if (size == 0 || count == 0) return 0;
        const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
        if (whole == 0 && ++empty_reads_ > 1000) throw std::runtime_error("the file ends early");
        std::memcpy(out, bytes_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        // Offsets from the end are negative in the disguise of an unsigned number.
        const std::size_t from = origin == aiOrigin_SET   ? 0
                                 : origin == aiOrigin_CUR ? at_
                                                          : bytes_.size();
        if (from + offset > bytes_.size()) return aiReturn_FAILURE;
        at_ = from + offset;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return at_; }
    std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::string bytes_;
    std::size_t at_ = 0;
    int empty_reads_ = 0;
};

// glTF 1 and containers whose lengths lie lead Assimp astray: only well-formed version 2 goes on.
void check_gltf(const std::string& path) {
    const std::string bytes = read_bytes(path);
    std::string_view json = bytes;
    if (lower_extension(path) == ".glb") {
        const auto word = [&](std::size_t at) {
            std::uint32_t w = 0;
            if (at + 4 <= bytes.size()) std::memcpy(&w, bytes.data() + at, 4);
            return static_cast<std::size_t>(w);
        };
        const bool is_container = bytes.size() >= 20 && bytes.compare(0, 4, "glTF") == 0 &&
                                  word(4) == 2 && word(8) == bytes.size() &&
                                  word(12) <= bytes.size() - 20 &&
                                  bytes.compare(16, 4, "JSON") == 0;
        if (!is_container) refuse(path, "is no container of glTF 2, or is cut off");
        const std::size_t next = 20 + word(12);
        if (next < bytes.size() &&
            (next + 8 > bytes.size() || word(next) > bytes.size() - next - 8)) {
            refuse(path, "has a broken chunk of data");
        }
        json = json.substr(20, word(12));
    }
    const std::size_t at = json.find("\"version\"");
    const std::size_t value =
        at == json.npos ? json.npos : json.find_first_not_of(" \t\r\n:", at + 9);
    if (value == json.npos || json.substr(value, 3) != "\"2.") refuse(path, "is not of glTF 2");
}

class MemoryFiles : public Assimp::IOSystem {
  public:
    bool Exists(const char* path) const override {
        std::error_code ignored;
        return fs::is_regular_file(path, ignored);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char*) override {
        if (!Exists(path)) return nullptr;
        return new MemoryStream(read_bytes(path));
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }
};

Vec3f to_vec(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

// Sends points to where the node of a part stands; normals by the cofactors.
struct Placement {
    aiMatrix4x4 points;
    aiMatrix3x3 normals;
    bool is_mirror = false;

    explicit Placement(const aiMatrix4x4& m) : points(m), normals(m) {
        is_mirror = normals.Determinant() < 0;
        normals.Inverse().Transpose();
    }
};

// Appends one part. Assimp has one list of points per part, each with all attributes.
void append(Mesh& mesh, const aiMesh& part, const Placement& placement, bool with_normals,
            bool with_uvs) {
    const std::size_t first = mesh.points.size();
    if (first + part.mNumVertices > std::numeric_limits<int>::max()) {
        throw std::runtime_error("it has more than 2^31 points");
    }
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        mesh.points.push_back(to_vec(placement.points * part.mVertices[i]));
        if (with_normals) mesh.normals.push_back(to_vec(placement.normals * part.mNormals[i]));
        if (with_uvs) {
            const aiVector3D& uv = part.mTextureCoords[0][i];
            mesh.uvs.push_back({uv.x, uv.y});
        }
    }
    std::vector<int> corners;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices < 3) continue;  // points and lines
        corners.clear();
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            if (face.mIndices[k] >= part.mNumVertices) {
                throw std::runtime_error("a face has a point that does not exist");
            }
            corners.push_back(static_cast<int>(first + face.mIndices[k]));
        }
        if (placement.is_mirror) std::reverse(corners.begin(), corners.end());
        if (!add_polygon(mesh, corners)) {
            throw std::runtime_error("a face has more than 1024 corners and is not convex");
        }
    }
}

// The parts of a node and of those below it.
template <class F>
void for_parts(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, int depth,
               F&& f) {
    if (depth > 256) throw std::runtime_error("its nodes lie too deep");
    const aiMatrix4x4 here = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        if (node.mMeshes[m] < scene.mNumMeshes && scene.mMeshes[node.mMeshes[m]]->mVertices) {
            f(*scene.mMeshes[node.mMeshes[m]], here);
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
        for_parts(scene, *node.mChildren[c], here, depth + 1, f);
    }
}

Mesh merge(const aiScene& scene) {
    Mesh mesh;
    if (!scene.mRootNode) return mesh;
    // An attribute that one part lacks would have to be invented.
    bool with_normals = true, with_uvs = true;
    for_parts(scene, *scene.mRootNode, {}, 0, [&](const aiMesh& part, const aiMatrix4x4&) {
        with_normals = with_normals && part.HasNormals();
        with_uvs = with_uvs && part.HasTextureCoords(0);
    });
    for_parts(scene, *scene.mRootNode, {}, 0, [&](const aiMesh& part, const aiMatrix4x4& place) {
        append(mesh, part, Placement(place), with_normals, with_uvs);
    });
    return mesh;
}

// A normal of no length, or one that is not finite, cannot be shaded.
void make_unit_normals(Mesh& mesh) {
    for (const Vec3f& n : mesh.normals) {
        if (!(dot(n, n) > 1e-12f && dot(n, n) < 1e12f)) {
            mesh.normals.clear();
            break;
        }
    }
    for (Vec3f& n : mesh.normals) n = normalize(n);
}

void take_color(MeshFile& file, const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const unsigned index = scene.mMeshes[m]->mMaterialIndex;
        if (index >= scene.mNumMaterials) continue;
        const aiMaterial& material = *scene.mMaterials[index];
        aiString name;
        material.Get(AI_MATKEY_NAME, name);
        if (std::string(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME) continue;
        aiColor4D color;
        if (material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS ||
            material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) {
            file.base_color = Vec3f{color.r, color.g, color.b};
        }
        aiString texture;
        if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &texture) == AI_SUCCESS ||
            material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == AI_SUCCESS) {
            file.base_color_file = texture.C_Str();
        }
        if (file.base_color || !file.base_color_file.empty()) return;
    }
}

// By Assimp.
MeshFile read_gltf(const std::string& path) {
    MeshFile file;
    check_gltf(path);
    Assimp::Importer importer;
    try {
        importer.SetIOHandler(new MemoryFiles);  // which it deletes
        const aiScene* scene = importer.ReadFile(path, 0);
        if (!scene) refuse(path, fmt::format("cannot be read ({})", importer.GetErrorString()));
        file.mesh = merge(*scene);
        take_color(file, *scene);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, path, "the memory does not suffice for this mesh");
    } catch (const std::exception& e) {
        refuse(path, fmt::format("cannot be read ({})", e.what()));
    }
    return file;
}

// Keeps what can be used.
void check_color(MeshFile& file, const std::string& path, Job& job) {
    if (file.base_color) {
        const Vec3f& c = *file.base_color;
        if (!(min_component(c) >= 0 && max_component(c) <= 1)) {
            job.warn(
                fmt::format("{}: its colour ({:.3g}, {:.3g}, {:.3g}) is not from 0 to 1 and "
                            "is not used; give albedo of the solid",
                            path, c.x, c.y, c.z));
            file.base_color = {};
        }
    }
    if (file.base_color_file.empty()) return;
    if (file.base_color_file.front() == '*') {
        job.warn(path + ": a picture packed into it is not used; give one as texture of the solid");
        file.base_color_file.clear();
        return;
    }
    const auto folder = std::filesystem::path(path).parent_path();
    file.base_color_file = (folder / file.base_color_file).string();
}

}  // namespace

const std::vector<std::string>& mesh_extensions() {
    static const std::vector<std::string> extensions{".obj", ".ply", ".gltf", ".glb"};
    return extensions;
}

MeshFile read_mesh(const std::string& path, Job& job) {
    check_path(path);
    const PhaseTimer timer(job, "read meshes");
    MeshFile file;
    if (lower_extension(path) == ".ply") {
        file.mesh = read_ply(path);
        return file;
    }
    file = lower_extension(path) == ".obj" ? read_obj(path, job) : read_gltf(path);
    make_unit_normals(file.mesh);
    if (file.mesh.triangles.empty()) refuse(path, "has no triangles");
    check_color(file, path, job);
    return file;
}

}  // namespace gischt
