// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_check.h"

#include <fmt/format.h>

#include <bit>
#include <vector>

#include "io/vdb_bytes.h"

namespace gischt {

namespace {

// How a value type is laid out in a file.
struct Layout {
    const char* type;
    int size;        // bytes of a value in a tree
    int components;  // that become 16-bit each in half-float grids, or 0: never
};

constexpr Layout layouts[] = {{"float", 4, 1},  {"double", 8, 1}, {"vec3s", 12, 3},
                              {"vec3d", 24, 3}, {"int32", 4, 0},  {"int64", 8, 0},
                              {"vec3i", 12, 0}, {"bool", 1, 0},   {"mask", 1, 0}};

constexpr std::uint32_t zip = 1, active_mask = 2, blosc = 4;  // OpenVDB's compression flags
constexpr int leaf_size = 512, leaf_mask_bytes = leaf_size / 8;
constexpr int leaf_edge = 8, root_child = 4096;  // cells

class TreeWalk {
  public:
    TreeWalk(const std::string& path, const VdbEntry& entry, const Layout& layout)
        : in_(path), entry_(entry), layout_(layout) {
        in_.seek(entry.data);
    }

    void run() {
        skip_transform();
        if (in_.number<std::int32_t>() != 1) fail("it has more than one buffer");
        walk_root();
        for (std::int64_t leaf = 0; leaf < leafs_; ++leaf) walk_leaf_values();
        if (in_.position() > entry_.end) fail("it is longer than its place in the file");
    }

  private:
    [[noreturn]] void fail(const std::string& why) {
        in_.fail(fmt::format("grid '{}' is broken ({})", entry_.name, why),
                 "copy or write the file again");
    }

    // Affine maps are numbers only: a matrix, or a scale with four derived vectors, a translation.
    void skip_transform() {
        const std::pair<const char*, int> maps[] = {{"AffineMap", 128},
                                                    {"UnitaryMap", 128},
                                                    {"ScaleMap", 120},
                                                    {"UniformScaleMap", 120},
                                                    {"TranslationMap", 24},
                                                    {"ScaleTranslateMap", 144},
                                                    {"UniformScaleTranslateMap", 144}};
        const std::string type = in_.text();
        for (const auto& [name, bytes] : maps) {
            if (type == name) return in_.skip(bytes);
        }
        fail(fmt::format("no transform is called '{}'", type));
    }

    void walk_root() {
        in_.skip(layout_.size);  // background
        const auto tiles = in_.number<std::uint32_t>(), children = in_.number<std::uint32_t>();
        for (std::uint32_t t = 0; t < tiles; ++t) {
            walk_origin(root_child);
            in_.skip(layout_.size);
            if (in_.number<std::uint8_t>() > 1) fail("a tile is neither active nor inactive");
        }
        for (std::uint32_t c = 0; c < children; ++c) {
            walk_origin(root_child);
            walk_node(5);
        }
    }

    // The lowest cell of a node or tile: a multiple of its edge. Others would make leafs that lie
    // across tiles.
    void walk_origin(int edge) {
        for (int axis = 0; axis < 3; ++axis) {
            if (in_.number<std::int32_t>() % edge != 0) fail("a node lies off its place");
        }
    }

    // A node of 2^(3 log) entries: the mask of children, the mask of active values, the values,
    // the children. Below the nodes of log 4 are leafs, whose topology is their mask.
    void walk_node(int log) {
        const int entries = 1 << 3 * log;
        const auto child_mask = mask(entries);
        const int active = count_on(mask(entries));
        skip_values(entries, active);
        const int children = count_on(child_mask);
        if (log == 5) {
            for (int c = 0; c < children; ++c) walk_node(4);
        } else {
            in_.skip(std::int64_t{leaf_mask_bytes} * children);
            leafs_ += children;
        }
    }

    void walk_leaf_values() {
        const std::string type = layout_.type;
        if (type == "bool" || type == "mask") {
            in_.skip(leaf_mask_bytes);
            walk_origin(leaf_edge);
            in_.skip(type == "bool" ? leaf_mask_bytes : 0);
            return;
        }
        skip_values(leaf_size, count_on(mask(leaf_size)));
    }

    std::vector<std::uint64_t> mask(int bits) {
        std::vector<std::uint64_t> words(static_cast<std::size_t>(bits / 64));
        in_.read(reinterpret_cast<char*>(words.data()), words.size() * 8);
        return words;
    }
    static int count_on(const std::vector<std::uint64_t>& words) {
        int n = 0;
        for (const std::uint64_t w : words) n += std::popcount(w);
        return n;
    }

    // What io::readCompressedValues of OpenVDB reads: a code that says which inactive values and
    // masks follow (0 to 6), these, and the values, of which mask compression keeps the active.
    void skip_values(int entries, int active) {
        const int code = in_.number<std::int8_t>();
        if (code < 0 || code > 6) fail(fmt::format("no values are coded as {}", code));
        const bool one_inactive = code == 2 || code == 4, two_inactive = code == 5;
        const bool selection = code >= 3 && code <= 5;
        in_.skip(layout_.size * (one_inactive ? 1 : two_inactive ? 2 : 0));
        if (selection) in_.skip(entries / 8);
        const int stored = (entry_.compression & active_mask) != 0 && code != 6 ? active : entries;
        const bool as_half = entry_.is_half && layout_.components > 0;
        if (as_half && stored == 0) return;
        skip_chunk(std::int64_t{stored} * (as_half ? 2 * layout_.components : layout_.size));
    }

    // A compressed chunk begins with its size; zero or negative means stored as it is.
    void skip_chunk(std::int64_t bytes) {
        if ((entry_.compression & (blosc | zip)) == 0) return in_.skip(bytes);
        const auto size = in_.number<std::int64_t>();
        if (size <= 0) {
            if (size != -bytes) fail("a chunk of values has the wrong size");
            return in_.skip(bytes);
        }
        if (size > in_.left()) in_.fail_short();
        if ((entry_.compression & blosc) == 0) return in_.skip(size);

        // Blosc's own header repeats both sizes, and its decoder believes it.
        constexpr std::int64_t header = 16;
        if (size < header) fail("a chunk of values is too short");
        in_.skip(4);
        const auto whole = in_.number<std::uint32_t>();
        in_.skip(4);
        const auto packed = in_.number<std::uint32_t>();
        if (whole != bytes || packed != size) fail("a chunk of values has the wrong size");
        in_.skip(size - header);
    }

    VdbBytes in_;
    const VdbEntry& entry_;
    const Layout& layout_;
    std::int64_t leafs_ = 0;
};

}  // namespace

void check_vdb_tree(const std::string& path, const VdbEntry& entry) {
    for (const Layout& layout : layouts) {
        if (entry.value_type() == layout.type) TreeWalk(path, entry, layout).run();
    }
}

}  // namespace gischt
