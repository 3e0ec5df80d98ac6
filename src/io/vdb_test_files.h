// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "base/job.h"
#include "grid/frame.h"
#include "io/test_files.h"

namespace gischt {

// VDB files byte by byte (format 224, uncompressed), for grids that gischt does not write: other
// value types, classes, places, and lies. What read_vdb() makes of them is compared with what was
// put in here, without a line of OpenVDB in between.
class VdbText {
  public:
    template <class T>
    VdbText& number(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        bytes.append(raw, sizeof(T));
        return *this;
    }
    VdbText& text(const std::string& s) {
        number(static_cast<std::uint32_t>(s.size()));
        bytes += s;
        return *this;
    }
    std::string bytes;
};

using TextMap = std::map<std::string, std::string>;

inline std::string metadata_bytes(const TextMap& metadata) {
    VdbText out;
    out.number(static_cast<std::uint32_t>(metadata.size()));
    for (const auto& [key, value] : metadata) out.text(key).text("string").text(value);
    return out.bytes;
}

// Index (i,j,k) to h (i,j,k) + t.
inline std::string scale_translate_bytes(double h, const Vec3d& t) {
    VdbText out;
    out.text("UniformScaleTranslateMap");
    for (int a = 0; a < 3; ++a) out.number(t[a]);
    for (const double v : {h, h, 1 / h, 1 / (h * h), 0.5 / h}) {
        for (int a = 0; a < 3; ++a) out.number(v);
    }
    return out.bytes;
}

// One leaf per entry, all in the 128^3 cells at the origin, z fastest; every value is active.
template <class T>
struct TreeText {
    T background{};
    std::map<std::array<int, 3>, std::array<T, 512>> leafs;  // by origin
    // Tiles of the root: 4096^3 cells, active.
    std::map<std::array<int, 3>, T> tiles;
    // Tiles of the node above the leafs: 8^3 cells at a multiple of 8, active.
    std::map<std::array<int, 3>, T> small_tiles;

    std::string bytes() const {
        VdbText out;
        out.number(std::int32_t{1}).number(background);
        out.number(static_cast<std::uint32_t>(tiles.size()));
        out.number(std::uint32_t{leafs.empty() && small_tiles.empty() ? 0u : 1u});
        for (const auto& [origin, value] : tiles) {
            for (const int c : origin) out.number(c);
            out.number(value).number(char{1});
        }
        if (!leafs.empty() || !small_tiles.empty()) nodes(out);
        return out.bytes;
    }

  private:
    static std::size_t bit(const std::array<int, 3>& o) {
        return static_cast<std::size_t>((o[0] / 8) << 8 | (o[1] / 8) << 4 | o[2] / 8);
    }
    static void mask(VdbText& out, std::size_t bits, const std::vector<std::size_t>& on) {
        std::string m(bits / 8, '\0');
        for (const std::size_t b : on) m[b / 8] = static_cast<char>(m[b / 8] | 1 << b % 8);
        out.bytes += m;
    }
    void nodes(VdbText& out) const {
        constexpr char all_values = 6;
        for (int a = 0; a < 3; ++a) out.number(0);
        mask(out, 32768, {0});
        mask(out, 32768, {});
        out.number(all_values);
        for (int n = 0; n < 32768; ++n) out.number(background);

        std::map<std::size_t, const std::array<T, 512>*> sorted;
        for (const auto& [origin, values] : leafs) sorted[bit(origin)] = &values;
        std::vector<std::size_t> children, active;
        for (const auto& [b, values] : sorted) children.push_back(b);
        std::vector<T> values(4096, background);
        for (const auto& [origin, value] : small_tiles) {
            active.push_back(bit(origin));
            values[bit(origin)] = value;
        }
        mask(out, 4096, children);
        mask(out, 4096, active);
        out.number(all_values);
        for (const T& v : values) out.number(v);
        const std::string full(64, '\xff');
        for (std::size_t n = 0; n < children.size(); ++n) out.bytes += full;
        for (const std::size_t b : children) {
            const int n = static_cast<int>(b);
            leaf_values(out, {8 * (n >> 8), 8 * (n >> 4 & 15), 8 * (n & 15)}, *sorted.at(b));
        }
    }
    static void leaf_values(VdbText& out, const std::array<int, 3>& origin,
                            const std::array<T, 512>& leaf) {
        constexpr char all_values = 6;
        out.bytes += std::string(64, '\xff');
        if constexpr (sizeof(T) == 1) {  // bool: the origin and a bit mask of values
            for (const int c : origin) out.number(c);
            std::vector<std::size_t> on;
            for (std::size_t n = 0; n < 512; ++n) {
                if (leaf[n]) on.push_back(n);
            }
            mask(out, 512, on);
        } else {
            out.number(all_values);
            for (const T& v : leaf) out.number(v);
        }
    }
};

// The same of f(i,j,k) for all 512 cells of a leaf.
template <class T, class F>
std::array<T, 512> leaf_of(F&& f) {
    std::array<T, 512> out;
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
            for (int k = 0; k < 8; ++k)
                out[static_cast<std::size_t>(i << 6 | j << 3 | k)] = f(i, j, k);
        }
    }
    return out;
}

struct GridText {
    std::string name{}, type{};  // "float" ...
    std::string tree{};          // TreeText::bytes()
    TextMap metadata{{"class", "fog volume"}};
    double h = 1;
    Vec3d at{};               // of index (0,0,0)
    std::string transform{};  // instead of h and at
};

inline std::string vdb_file(const std::vector<GridText>& grids, const TextMap& metadata = {}) {
    VdbText out;
    out.number(std::uint64_t{0x56444220}).number(std::uint32_t{224});
    out.number(std::uint32_t{10}).number(std::uint32_t{0}).number(char{1});
    out.bytes += "01234567-0123-0123-0123-0123456789ab" + metadata_bytes(metadata);
    out.number(static_cast<std::int32_t>(grids.size()));
    for (const GridText& g : grids) {
        const std::string content =
            VdbText().number(std::uint32_t{0}).bytes + metadata_bytes(g.metadata) +
            (g.transform.empty() ? scale_translate_bytes(g.h, g.at) : g.transform) + g.tree;
        out.text(g.name).text("Tree_" + g.type + "_5_4_3").text("");
        const auto begin = static_cast<std::int64_t>(out.bytes.size() + 24);
        const auto end = begin + static_cast<std::int64_t>(content.size());
        out.number(begin).number(begin).number(end);
        out.bytes += content;
    }
    return out.bytes;
}

// A job that remembers what it was told.
struct Listener {
    Job job;
    std::vector<std::string> infos, warnings;

    Listener() {
        job.on_message = [this](Job::Level level, std::string_view text) {
            (level == Job::Level::Warning ? warnings : infos).emplace_back(text);
        };
    }
};

// A field of random values on some of the tiles around the origin, negative ones too; a quarter of
// the cells is background.
inline Field random_field(std::uint64_t seed, int components, float background = 0) {
    std::vector<Vec3i> tiles;
    for (int k = -2; k < 2; ++k) {
        for (int j = -2; j < 2; ++j) {
            for (int i = -2; i < 2; ++i) {
                const auto key = static_cast<std::uint64_t>(i + 8 * j + 64 * k + 1000);
                if (random_uniform(random_key(seed, key), 0) < 0.4f) tiles.emplace_back(i, j, k);
            }
        }
    }
    const auto map = TileMap::sparse(std::move(tiles), {Vec3i(-16), Vec3i(16)});
    Field field;
    for (int c = 0; c < components; ++c) {
        field.background[static_cast<std::size_t>(c)] = background;
        TileField<float> values(map, background);
        for (std::size_t n = 0; n < values.values().size(); ++n) {
            const std::uint64_t key = random_key(seed, n, static_cast<std::uint64_t>(c));
            if (random_uniform(key, 0) > 0.25f) {
                values.values()[n] = background + 10 * random_uniform(key, 1) - 5;
            }
        }
        field.component.push_back(std::move(values));
    }
    return field;
}

}  // namespace gischt
