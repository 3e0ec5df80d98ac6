// SPDX-License-Identifier: Apache-2.0
#include "io/obj.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

// A text line by line and word by word; a backslash at the end of a line joins the next one to it.
class ObjText {
  public:
    explicit ObjText(const std::string& path) : path_(path), text_(read_bytes(path)) {
        for (std::size_t at = 0; (at = text_.find('\\', at)) != text_.npos; ++at) {
            const std::size_t end = text_.find_first_not_of('\r', at + 1);
            if (end == text_.npos || text_[end] != '\n') continue;
            for (std::size_t i = at; i <= end; ++i) text_[i] = ' ';
            ++joined_;
        }
        rest_ = text_;
    }

    // Goes to the next line; false at the end.
    bool next() {
        if (rest_.empty()) return false;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        line_ = line_.substr(0, line_.find_first_of("#\r"));
        ++number_;
        return true;
    }
    // The next word of the line; empty at its end.
    std::string_view word() {
        skip_blanks();
        const std::string_view w =
            line_.substr(0, std::min(line_.find_first_of(blanks), line_.size()));
        line_.remove_prefix(w.size());
        return w;
    }
    // What is left of the line, without blanks around it.
    std::string_view remainder() {
        skip_blanks();
        return line_.substr(0, line_.find_last_not_of(blanks) + 1);
    }
    // The next word as a number; `missing` where there is none.
    float number(double missing) {
        std::string_view w = word();
        if (w.empty() && std::isfinite(missing)) return static_cast<float>(missing);
        if (w.starts_with('+')) w.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
        const auto number = static_cast<float>(value);
        if (error != std::errc() || end != w.data() + w.size() || !std::isfinite(number))
            fail("has a number that is none, or not finite");
        return number;
    }
    [[noreturn]] void fail(const std::string& what) const {
        // Joined lines are counted as one.
        const std::string about = joined_ > 0 ? "about " : "";
        throw Error(ErrorKind::Input, path_, fmt::format("{} ({}line {})", what, about, number_));
    }

  private:
    static constexpr std::string_view blanks = " \t\v\f";
    void skip_blanks() {
        line_.remove_prefix(std::min(line_.find_first_not_of(blanks), line_.size()));
    }

    std::string path_, text_;
    std::string_view rest_, line_;
    std::size_t number_ = 0, joined_ = 0;
};

constexpr double needed = std::numeric_limits<double>::quiet_NaN();

struct ObjMaterial {
    std::optional<Vec3f> color;
    std::string picture;
};
using ObjMaterials = std::map<std::string, ObjMaterial, std::less<>>;

void read_materials(const std::string& path, ObjMaterials& materials) {
    ObjText in(path);
    ObjMaterial* material = nullptr;
    while (in.next()) {
        const std::string_view key = in.word();
        if (key == "newmtl") material = &materials[std::string(in.remainder())];
        if (!material) continue;
        if (key == "Kd") {
            const float r = in.number(needed);
            const float g = in.number(static_cast<double>(r)),
                        b = in.number(static_cast<double>(r));
            material->color = Vec3f{r, g, b};
        } else if (key == "map_Kd") {
            // A name may hold blanks; behind options it is the last word.
            std::string_view name = in.remainder();
            if (name.starts_with('-')) name.remove_prefix(name.find_last_of(" \t") + 1);
            material->picture = name;
        }
    }
}

// Indices of a corner's place, texture coordinates and normal; -1 for what it does not have.
using ObjCorner = std::array<int, 3>;
struct ObjCornerHash {
    std::size_t operator()(const ObjCorner& c) const {
        std::uint64_t h = 0;
        for (const int i : c) h = mix64(h ^ static_cast<std::uint32_t>(i));
        return h;
    }
};

class ObjReader {
  public:
    ObjReader(const std::string& path, Job& job) : path_(path), in_(path), job_(job) {}

    MeshFile read() {
        while (in_.next()) {
            const std::string_view key = in_.word();
            if (key == "v") {
                places_.push_back(triple(needed));
            } else if (key == "vn") {
                normals_.push_back(triple(needed));
            } else if (key == "vt") {
                const float u = in_.number(needed);
                uvs_.push_back({u, in_.number(0)});
            } else if (key == "f" || key == "fo") {
                read_face();
            } else if (key == "usemtl") {
                material_ = in_.remainder();
            } else if (key == "mtllib") {
                read_library(std::string(in_.remainder()));
            }
        }
        make_points();
        return std::move(file_);
    }

  private:
    Vec3f triple(double missing) {
        const float x = in_.number(missing), y = in_.number(missing);
        return {x, y, in_.number(missing)};
    }

    // An index from 1, or from the end where it is negative.
    int index(std::string_view word, std::size_t count) {
        long long value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const auto n = static_cast<long long>(count);
        if (value < 0) value += n + 1;
        if (error != std::errc() || end != word.data() + word.size() || value < 1 || value > n)
            in_.fail(fmt::format("has a face of '{}', which is not there", word.substr(0, 40)));
        return static_cast<int>(value - 1);
    }
    // v, v/vt, v//vn or v/vt/vn.
    ObjCorner corner(std::string_view word) {
        const std::array<std::size_t, 3> counts{places_.size(), uvs_.size(), normals_.size()};
        ObjCorner c{-1, -1, -1};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::string_view part = word.substr(0, word.find('/'));
            if (!part.empty() || k == 0) c[k] = index(part, counts[k]);
            if (part.size() == word.size()) return c;
            word.remove_prefix(part.size() + 1);
        }
        in_.fail("has a face that is not understood");
    }
    void read_face() {
        std::vector<int> polygon;
        for (std::string_view w = in_.word(); !w.empty(); w = in_.word()) {
            const auto [found, is_new] =
                point_of_.try_emplace(corner(w), static_cast<int>(corners_.size()));
            if (is_new) corners_.push_back(found->first);
            polygon.push_back(found->second);
            // As add_polygon() sees it.
            if (is_new)
                file_.mesh.points.push_back(places_[static_cast<std::size_t>(found->first[0])]);
        }
        if (polygon.size() < 3) in_.fail("has a face of fewer than three corners");
        if (!add_polygon(file_.mesh, polygon))
            in_.fail("has a face of more than 1024 corners that is not convex");
        take_color();
    }
    void take_color() {
        const auto found = materials_.find(material_);
        if (found == materials_.end() || file_.base_color || !file_.base_color_file.empty()) return;
        file_.base_color = found->second.color;
        file_.base_color_file = found->second.picture;
    }
    void read_library(const std::string& name) {
        const auto path = (std::filesystem::path(path_).parent_path() / name).string();
        try {
            read_materials(path, materials_);
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::Input) throw;
            job_.warn(fmt::format("{}: its materials are not used: {}", path_, e.what()));
        }
    }
    // Texture coordinates and normals, where all corners have them.
    void make_points() {
        bool with_uvs = true, with_normals = true;
        for (const ObjCorner& c : corners_) {
            with_uvs = with_uvs && c[1] >= 0;
            with_normals = with_normals && c[2] >= 0;
        }
        for (const ObjCorner& c : corners_) {
            if (with_uvs) file_.mesh.uvs.push_back(uvs_[static_cast<std::size_t>(c[1])]);
            if (with_normals)
                file_.mesh.normals.push_back(normals_[static_cast<std::size_t>(c[2])]);
        }
    }

    std::string path_;
    ObjText in_;
    Job& job_;
    std::vector<Vec3f> places_, normals_;
    std::vector<Vec2f> uvs_;
    std::vector<ObjCorner> corners_;  // of the mesh's points
    std::unordered_map<ObjCorner, int, ObjCornerHash> point_of_;
    ObjMaterials materials_;
    std::string material_;
    MeshFile file_;
};

}  // namespace

MeshFile read_obj(const std::string& path, Job& job) {
    return ObjReader(path, job).read();
}

}  // namespace gischt
