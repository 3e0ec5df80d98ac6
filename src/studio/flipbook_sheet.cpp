// SPDX-License-Identifier: Apache-2.0
#include "studio/flipbook_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"
#include "image/color.h"

namespace gischt {

SheetLayout square_sheet(int cells, Vec2i cell) {
    SheetLayout layout{1, 1, cell.x, cell.y};
    check_sheet(layout, 1);
    const double columns = std::ceil(std::sqrt(static_cast<double>(cells) * cell.y / cell.x));
    layout.columns = std::clamp(static_cast<int>(columns), 1, std::max(cells, 1));
    layout.rows = cells / layout.columns + (cells % layout.columns != 0 ? 1 : 0);
    check_sheet(layout, cells);
    return layout;
}

void check_sheet(const SheetLayout& layout, int cells) {
    for (const int n : {layout.columns, layout.rows, layout.cell_width, layout.cell_height}) {
        if (n >= 1 && n <= widest_sheet) continue;
        throw Error(ErrorKind::Usage, "flipbook",
                    fmt::format("a grid of {} x {} cells of {} x {} pixels", layout.columns,
                                layout.rows, layout.cell_width, layout.cell_height),
                    fmt::format("each number must be 1 to {}", widest_sheet));
    }
    // The products of two such numbers fit into an int.
    if (std::max(layout.width(), layout.height()) > widest_sheet) {
        throw Error(ErrorKind::Usage, "flipbook",
                    fmt::format("a sheet of {} x {} pixels is larger than {}", layout.width(),
                                layout.height(), widest_sheet),
                    "take smaller cells (--cell) or fewer of them (--frames A-BxSTEP)");
    }
    if (layout.cells() < cells) {
        throw Error(ErrorKind::Usage, "flipbook",
                    fmt::format("{} frames do not fit into {} x {} cells", cells, layout.columns,
                                layout.rows),
                    "take a larger --grid, or fewer frames (--frames A-BxSTEP)");
    }
}

void check_loop(int frames, int loop) {
    if (loop >= 0 && frames / 2 >= loop) return;
    throw Error(ErrorKind::Usage, "flipbook",
                fmt::format("{} frames cannot fade over {} of them", frames, loop),
                fmt::format("--loop takes 0 to {}", frames / 2));
}

CellShare cell_share(int frame, int frames, int loop) {
    const int cells = frames - loop;
    const auto steps = static_cast<float>(loop + 1);
    if (frame < loop) return {cells - loop + frame, static_cast<float>(frame + 1) / steps};
    if (frame < cells) return {frame - loop, 1};
    return {frame - loop, static_cast<float>(frames - frame) / steps};
}

void add_cell(Image& sheet, const SheetLayout& layout, int cell, const Image& part, float weight) {
    GISCHT_ASSERT(part.width == layout.cell_width && part.height == layout.cell_height);
    const Vec2i corner = layout.corner(cell);
    for (Channel& to : sheet.planes) {
        const Channel* from = part.find(to.name);
        if (!from) continue;
        for (int y = 0; y < part.height; ++y) {
            const float* source = from->values.data() + part.index(0, y);
            float* target = to.values.data() + sheet.index(corner.x, corner.y + y);
            for (int x = 0; x < part.width; ++x) target[x] += weight * source[x];
        }
    }
}

namespace {

// The rings of uncovered texels around the covered ones of a cell, from the inside out; each texel
// takes the mean of its neighbours of earlier rings.
class EdgePadding {
  public:
    EdgePadding(Image& sheet, const SheetLayout& layout, int cell)
        : sheet_(sheet),
          layout_(layout),
          corner_(layout.corner(cell)),
          ring_(static_cast<std::size_t>(layout.cell_width * layout.cell_height), unknown) {
        const auto coverage = sheet.channel("A");
        for (int y = 0; y < layout.cell_height; ++y) {
            for (int x = 0; x < layout.cell_width; ++x) {
                if (coverage[texel({x, y})] >= least_coverage) ring_[place({x, y})] = 0;
            }
        }
    }

    void fill() {
        std::vector<Vec2i> now = next_to_ring(0);
        for (int ring = 1; !now.empty(); ++ring) {
            for (const Vec2i& at : now) take_mean(at, ring);
            now = next_to_ring(now, ring);
        }
    }

  private:
    static constexpr int unknown = -1;

    std::size_t place(Vec2i p) const {
        return static_cast<std::size_t>(p.y * layout_.cell_width + p.x);
    }
    std::size_t texel(Vec2i p) const { return sheet_.index(corner_.x + p.x, corner_.y + p.y); }

    template <class F>
    void for_neighbours(Vec2i p, F&& f) const {
        for (int y = std::max(0, p.y - 1); y <= std::min(layout_.cell_height - 1, p.y + 1); ++y) {
            for (int x = std::max(0, p.x - 1); x <= std::min(layout_.cell_width - 1, p.x + 1); ++x)
                f(Vec2i{x, y});
        }
    }
    // The unknown texels beside those of ring 0, which are then of ring 1.
    std::vector<Vec2i> next_to_ring(int ring) {
        std::vector<Vec2i> inside;
        for (int y = 0; y < layout_.cell_height; ++y) {
            for (int x = 0; x < layout_.cell_width; ++x) {
                if (ring_[place({x, y})] == ring) inside.push_back({x, y});
            }
        }
        return next_to_ring(inside, ring);
    }
    std::vector<Vec2i> next_to_ring(const std::vector<Vec2i>& inside, int ring) {
        std::vector<Vec2i> found;
        for (const Vec2i& p : inside) {
            for_neighbours(p, [&](Vec2i n) {
                if (ring_[place(n)] != unknown) return;
                ring_[place(n)] = ring + 1;
                found.push_back(n);
            });
        }
        return found;
    }
    void take_mean(Vec2i at, int ring) {
        for (Channel& c : sheet_.planes) {
            if (c.name == "A") continue;
            float sum = 0;
            int count = 0;
            for_neighbours(at, [&](Vec2i n) {
                const int r = ring_[place(n)];
                if (r == unknown || r >= ring) return;
                sum += c.values[texel(n)];
                ++count;
            });
            c.values[texel(at)] = sum / static_cast<float>(count);
        }
    }

    Image& sheet_;
    const SheetLayout& layout_;
    Vec2i corner_;
    std::vector<int> ring_;  // 0: covered
};

}  // namespace

void make_straight(Image& sheet, const SheetLayout& layout) {
    const auto coverage = std::as_const(sheet).channel("A");
    for (Channel& c : sheet.planes) {
        if (c.name == "A") continue;
        for (std::size_t i = 0; i < c.values.size(); ++i) {
            c.values[i] = coverage[i] >= least_coverage ? c.values[i] / coverage[i] : 0;
        }
    }
    for (int cell = 0; cell < layout.cells(); ++cell) EdgePadding(sheet, layout, cell).fill();
}

void carry_glow(Image& sheet, const Image& glow, float factor) {
    const auto coverage = sheet.channel("A");
    const auto [r, g, b] = glow.color();
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        const float light = factor * std::max({r[i], g[i], b[i]});
        coverage[i] = std::min(1.0f, std::max(coverage[i], light));
    }
}

static Image pack_sides(const Image& light, int first) {
    Image map = Image::rgba(light.width, light.height);
    const auto color = map.color();
    for (std::size_t c = 0; c < 3; ++c) {
        const auto side = light.channel(light_sides[static_cast<std::size_t>(first) + c]);
        std::copy(side.begin(), side.end(), color[c].begin());
    }
    map.metadata = light.metadata;
    return map;
}

Image pack_light_a(const Image& light) {
    Image map = pack_sides(light, 0);
    const auto coverage = light.channel("A");
    std::copy(coverage.begin(), coverage.end(), map.channel("A").begin());
    return map;
}

Image pack_light_b(const Image& light, const Image* glow, float glow_scale) {
    Image map = pack_sides(light, 3);
    if (!glow) return map;
    const auto [r, g, b] = glow->color();
    const auto a = map.channel("A");
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = luminance(Vec3f{r[i], g[i], b[i]}) / glow_scale;
    }
    return map;
}

}  // namespace gischt
