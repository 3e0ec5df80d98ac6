// SPDX-License-Identifier: Apache-2.0
#include "io/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Encoding { Ascii, Little, Big };
enum class Number { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct Property {
    std::string name;
    Number type = Number::Float32;
    std::optional<Number> list_count;  // type of the count, for a list
};
struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

std::size_t size_of(Number n) {
    switch (n) {
        case Number::Int8:
        case Number::Uint8:
            return 1;
        case Number::Int16:
        case Number::Uint16:
            return 2;
        case Number::Float64:
            return 8;
        default:
            return 4;
    }
}

std::optional<Number> number_named(std::string_view word) {
    struct Name {
        std::string_view word;
        Number number;
    };
    static constexpr Name names[] = {
        {"char", Number::Int8},      {"int8", Number::Int8},       {"uchar", Number::Uint8},
        {"uint8", Number::Uint8},    {"short", Number::Int16},     {"int16", Number::Int16},
        {"ushort", Number::Uint16},  {"uint16", Number::Uint16},   {"int", Number::Int32},
        {"int32", Number::Int32},    {"uint", Number::Uint32},     {"uint32", Number::Uint32},
        {"float", Number::Float32},  {"float32", Number::Float32}, {"double", Number::Float64},
        {"float64", Number::Float64}};
    for (const Name& n : names) {
        if (n.word == word) return n.number;
    }
    return std::nullopt;
}

// The file from its first byte to its last; every step checks that there is something left.
class PlyReader {
  public:
    explicit PlyReader(const std::string& path) : path_(path), bytes_(read_bytes(path)) {}

    Mesh read() {
        read_header();
        Mesh mesh;
        for (const Element& e : elements_) {
            check_room(e);
            if (e.name == "vertex") {
                read_points(e, mesh);
            } else if (e.name == "face") {
                read_faces(e, mesh);
            } else {
                for (std::size_t i = 0; i < e.count; ++i) {
                    for (const Property& p : e.properties) skip(p);
                }
            }
        }
        if (mesh.triangles.empty()) fail("has no faces");
        return mesh;
    }

    Particles read_particles() {
        read_header();
        Particles particles;
        bool has_points = false;
        for (const Element& e : elements_) {
            check_room(e);
            if (e.name == "vertex" && !has_points) {
                read_particles(e, particles);
                has_points = true;
                continue;
            }
            for (std::size_t i = 0; i < e.count; ++i) {
                for (const Property& p : e.properties) skip(p);
            }
        }
        if (!has_points) fail("has no points");
        return particles;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::Input, path_, what);
    }

    // ---- The header, line by line.
    std::string_view line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string::npos) fail("is cut off in its header, or no PLY file");
        std::string_view text(bytes_.data() + at_, end - at_);
        at_ = end + 1;
        if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
        return text;
    }
    static std::vector<std::string_view> words_of(std::string_view text) {
        std::vector<std::string_view> words;
        std::size_t i = 0;
        while ((i = text.find_first_not_of(" \t", i)) != text.npos) {
            const std::size_t end = std::min(text.find_first_of(" \t", i), text.size());
            words.push_back(text.substr(i, end - i));
            i = end;
        }
        return words;
    }
    void read_header() {
        if (line() != "ply") fail("is no PLY file");
        bool has_format = false;
        for (;;) {
            const auto words = words_of(line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format" && words.size() == 3) {
                read_format(words[1]);
                has_format = true;
            } else if (words[0] == "element" && words.size() == 3) {
                Element e;
                e.name = words[1];
                const auto [end, error] =
                    std::from_chars(words[2].data(), words[2].data() + words[2].size(), e.count);
                if (error != std::errc() || end != words[2].data() + words[2].size()) {
                    fail("has an element without a count");
                }
                elements_.push_back(std::move(e));
            } else if (words[0] == "property" && !elements_.empty()) {
                elements_.back().properties.push_back(read_property(words));
            } else {
                fail(fmt::format("has a line in its header that starts with '{}'", words[0]));
            }
        }
        if (!has_format) fail("does not say its format");
    }
    void read_format(std::string_view word) {
        if (word == "ascii") {
            encoding_ = Encoding::Ascii;
        } else if (word == "binary_little_endian") {
            encoding_ = Encoding::Little;
        } else if (word == "binary_big_endian") {
            encoding_ = Encoding::Big;
        } else {
            fail("has an unknown format");
        }
    }
    Property read_property(const std::vector<std::string_view>& words) const {
        Property p;
        const bool is_list = words.size() == 5 && words[1] == "list";
        if (!is_list && words.size() != 3) fail("has a property that is not understood");
        const auto type = number_named(words[words.size() - 2]);
        if (is_list) p.list_count = number_named(words[2]);
        if (!type || (is_list && !p.list_count)) fail("has a property of unknown type");
        p.type = *type;
        p.name = words.back();
        return p;
    }
    // A count that the bytes left cannot hold is a lie, and would fill the memory.
    void check_room(const Element& e) const {
        std::size_t least = 0;
        for (const Property& p : e.properties) {
            least += encoding_ == Encoding::Ascii ? 2 : size_of(p.list_count.value_or(p.type));
        }
        if (least == 0 && e.count > 0) fail("has an element without properties");
        if (e.count > 0 && e.count > (bytes_.size() - at_ + 1) / least) fail("is cut off");
    }

    // ---- Numbers.
    double number(Number type) {
        return encoding_ == Encoding::Ascii ? ascii_number() : binary_number(type);
    }
    double ascii_number() {
        while (at_ < bytes_.size() && std::strchr(" \t\r\n", bytes_[at_])) ++at_;
        double value = 0;
        const char* begin = bytes_.data() + at_;
        const auto [end, error] = std::from_chars(begin, bytes_.data() + bytes_.size(), value);
        if (error != std::errc()) fail(at_ == bytes_.size() ? "is cut off" : "has a bad number");
        at_ += static_cast<std::size_t>(end - begin);
        return value;
    }
    template <class T>
    double as(const unsigned char* raw) const {
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return static_cast<double>(value);
    }
    double binary_number(Number type) {
        const std::size_t n = size_of(type);
        if (bytes_.size() - at_ < n) fail("is cut off");
        unsigned char raw[8];
        std::memcpy(raw, bytes_.data() + at_, n);
        at_ += n;
        if (encoding_ == Encoding::Big) std::reverse(raw, raw + n);
        switch (type) {
            case Number::Int8:
                return as<std::int8_t>(raw);
            case Number::Uint8:
                return as<std::uint8_t>(raw);
            case Number::Int16:
                return as<std::int16_t>(raw);
            case Number::Uint16:
                return as<std::uint16_t>(raw);
            case Number::Int32:
                return as<std::int32_t>(raw);
            case Number::Uint32:
                return as<std::uint32_t>(raw);
            case Number::Float32:
                return as<float>(raw);
            case Number::Float64:
                return as<double>(raw);
        }
        return 0;
    }
    std::size_t list_length(const Property& p) {
        const double n = number(*p.list_count);
        // Each member takes a byte at least.
        if (!(n >= 0 && n <= static_cast<double>(bytes_.size() - at_))) fail("is cut off");
        return static_cast<std::size_t>(n);
    }
    void skip(const Property& p) {
        const std::size_t n = p.list_count ? list_length(p) : 1;
        for (std::size_t i = 0; i < n; ++i) number(p.type);
    }

    // ---- Points and faces.
    void read_points(const Element& e, Mesh& mesh) {
        struct Place {
            std::string_view name;
            int slot;
        };
        static constexpr Place places[] = {{"x", 0},  {"y", 1},  {"z", 2},         {"nx", 3},
                                           {"ny", 4}, {"nz", 5}, {"s", 6},         {"t", 7},
                                           {"u", 6},  {"v", 7},  {"texture_u", 6}, {"texture_v", 7},
                                           {"vx", 8}, {"vy", 9}, {"vz", 10}};
        std::vector<int> slots;
        bool has[11] = {};
        for (const Property& p : e.properties) {
            int slot = -1;
            for (const Place& place : places) {
                if (place.name == p.name && !p.list_count) slot = place.slot;
            }
            if (slot >= 0) has[slot] = true;
            slots.push_back(slot);
        }
        if (!(has[0] && has[1] && has[2])) fail("has points without x, y and z");
        const bool normals = has[3] && has[4] && has[5], uvs = has[6] && has[7],
                   velocities = has[8] && has[9] && has[10];
        for (std::size_t i = 0; i < e.count; ++i) {
            float v[11] = {};
            for (std::size_t k = 0; k < slots.size(); ++k) {
                if (slots[k] < 0) {
                    skip(e.properties[k]);
                } else {
                    v[slots[k]] = static_cast<float>(number(e.properties[k].type));
                }
            }
            mesh.points.emplace_back(v[0], v[1], v[2]);
            if (normals) mesh.normals.emplace_back(v[3], v[4], v[5]);
            if (uvs) mesh.uvs.push_back({v[6], v[7]});
            if (velocities) mesh.velocities.emplace_back(v[8], v[9], v[10]);
        }
    }
    // Where a particle's numbers go; `Unused` for what it does not have.
    enum Slot { X, Y, Z, Vx, Vy, Vz, Age, Life, Radius, Id, Opacity, Kelvin, R, G, B, Unused };

    static Slot slot_of(const Property& p) {
        static constexpr std::string_view names[] = {
            "x",      "y",  "z",       "vx",          "vy",  "vz",    "age", "life",
            "radius", "id", "opacity", "temperature", "red", "green", "blue"};
        const auto* found = std::find(std::begin(names), std::end(names), p.name);
        auto slot = static_cast<Slot>(found - std::begin(names));
        if (p.name == "pscale") slot = Radius;
        const bool is_real = p.type == Number::Float32 || p.type == Number::Float64;
        return p.list_count || (slot >= R && !is_real) ? Unused : slot;
    }
    void read_particles(const Element& e, Particles& out) {
        std::vector<Slot> slots;
        bool has[Unused + 1] = {};
        for (const Property& p : e.properties) {
            slots.push_back(slot_of(p));
            has[slots.back()] = true;
        }
        if (!(has[X] && has[Y] && has[Z])) fail("has points without x, y and z");
        if (has[R] && has[G] && has[B]) out.color.resize(1);
        if (has[Opacity]) out.opacity.resize(1);
        if (has[Kelvin]) out.temperature.resize(1);
        out.resize(e.count);
        for (std::size_t i = 0; i < e.count; ++i) {
            double v[Unused + 1] = {};
            v[Radius] = 0.01;
            v[Life] = std::numeric_limits<double>::infinity();
            v[Id] = static_cast<double>(i);
            for (std::size_t k = 0; k < slots.size(); ++k) {
                if (slots[k] == Unused) {
                    skip(e.properties[k]);
                    continue;
                }
                v[slots[k]] = number(e.properties[k].type);
                if (!std::isfinite(v[slots[k]]) && slots[k] != Life) {
                    fail("has a number that is not finite");
                }
            }
            set_particle(v, i, out);
        }
    }
    void set_particle(const double* v, std::size_t i, Particles& out) const {
        const auto number_at = [v](Slot s) { return static_cast<float>(v[s]); };
        // From here on the id would not fit its integer.
        if (!(v[Id] >= 0 && v[Id] < 0x1p63)) fail("has an id that is no number of a thing");
        out.position[i] = {v[X], v[Y], v[Z]};
        out.velocity[i] = {number_at(Vx), number_at(Vy), number_at(Vz)};
        out.age[i] = number_at(Age);
        out.life[i] = number_at(Life);
        out.radius[i] = number_at(Radius);
        out.id[i] = static_cast<std::uint64_t>(v[Id]);
        if (!out.color.empty()) out.color[i] = {number_at(R), number_at(G), number_at(B)};
        if (!out.opacity.empty()) out.opacity[i] = number_at(Opacity);
        if (!out.temperature.empty()) out.temperature[i] = number_at(Kelvin);
    }
    void read_faces(const Element& e, Mesh& mesh) {
        std::vector<int> corners;
        for (std::size_t i = 0; i < e.count; ++i) {
            for (const Property& p : e.properties) {
                const bool is_face = p.name == "vertex_indices" || p.name == "vertex_index";
                if (!is_face || !p.list_count) {
                    skip(p);
                    continue;
                }
                corners.clear();
                const std::size_t n = list_length(p);
                for (std::size_t k = 0; k < n; ++k) {
                    const double index = number(p.type);
                    if (!(index >= 0 && index < static_cast<double>(mesh.points.size()))) {
                        fail("has a face with a point that does not exist");
                    }
                    corners.push_back(static_cast<int>(index));
                }
                if (n >= 3 && !add_polygon(mesh, corners)) {
                    fail("has a face of more than 1024 corners that is not convex");
                }
            }
        }
    }

    std::string path_, bytes_;
    std::size_t at_ = 0;
    Encoding encoding_ = Encoding::Ascii;
    std::vector<Element> elements_;
};

}  // namespace

Mesh read_ply(const std::string& path) {
    return PlyReader(path).read();
}

Particles read_ply_particles(const std::string& path) {
    return PlyReader(path).read_particles();
}

}  // namespace gischt
