// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "optics/surface.h"
#include "render/zonal/zone_grid.h"

namespace gischt {

// What a side of the box of zones does to light that comes from within.
enum class EnclosureSide {
    Open,    // it leaves; from outside comes light that is the same in all directions
    Mirror,  // it is mirrored: one-dimensional enclosures have mirrors around
};

// A part of a surface, which reflects evenly (Lambert): what of one surface lies within one zone
// and faces one of six ways.
struct SurfacePatch {
    Vec3d center, normal;  // means of where lines met it, metres
    Vec3f albedo;
    int surface = 0;
    int hits = 0;
    std::vector<SurfaceHit> places;  // some of these, at random
};

// Zones, the patches of surfaces among them, and what lies around: the domain in which light is to
// be found. Its elements are the zones and after them the patches.
struct Enclosure {
    ZoneGrid grid;
    // -x +x -y +y -z +z
    std::array<EnclosureSide, 6> sides{};
    std::array<Vec3f, 6> incoming{};  // W/(m^2 sr), at open sides
    // Null, or the surfaces in the box; then all sides are open.
    const SurfaceSet* surfaces = nullptr;
    // Lines that start in each cell of an open side; some 6 times as many pass each zone.
    int lines = 16;

    std::vector<SurfacePatch> patches;
    std::unordered_map<std::uint64_t, int> patch_of_key;

    std::size_t elements() const { return grid.size() + patches.size(); }
    std::size_t first_patch() const { return grid.size(); }
    // Where the cells of a side begin among those of all sides, and their number.
    std::size_t first_side_cell(int side) const;
    std::size_t side_cells() const { return first_side_cell(6); }
    std::uint64_t patch_key(const SurfaceHit& hit) const;
};

// A zone that a line crosses. `flips`: which components of the line's direction mirrors have turned
// round by then, one bit per axis.
struct ZoneCrossing {
    std::uint32_t zone = 0;
    float length = 0;  // metres
    std::uint8_t flips = 0;
};

// A piece of a line between two ends, each a patch or a cell of a side.
struct LinePiece {
    std::size_t first = 0, last = 0;     // of the crossings
    int from_patch = -1, to_patch = -1;  // -1: a side
    int from_cell = -1, to_cell = -1;    // of all sides' cells
};

// Follows straight lines through an enclosure, each cut into pieces by the surfaces that it meets;
// what lies inside solids is left out. One per thread.
class LineTracer {
  public:
    explicit LineTracer(const Enclosure& enclosure) : enclosure_(enclosure) {}

    // From a point on a side, which `cell` is of, inwards; unit direction. Throws Error{Usage} when
    // mirrors keep it inside for ever.
    void trace(const Vec3d& origin, const Vec3d& direction, int cell);

    std::vector<ZoneCrossing> crossings;
    std::vector<LinePiece> pieces;

    // Called, where set, for each side of a surface that a line meets (in place of a look-up).
    int (*note)(void* context, const SurfaceHit& hit) = nullptr;
    void* context = nullptr;

  private:
    int walk(const Vec3d& from, const Vec3d& direction, double t_end);
    int patch_at(const SurfaceHit& hit) const;

    const Enclosure& enclosure_;
};

// A line that starts in a cell of an open side: evenly distributed over the cell and, by cosine,
// over the directions inwards. Each cell has its part of one sequence, which 4 x 4 cells share out.
struct StartingLine {
    Vec3d origin, direction;
    // Area times solid angle times cosine that it stands for, m^2 sr. Lines are used both ways and
    // start at both of their ends, so it is half of pi A / lines.
    float weight = 0;
};
StartingLine starting_line(const Enclosure& enclosure, int side, int cell_in_side, int index);

// The open sides of an enclosure, cut into a fixed number of tasks of equal size. A task is a range
// of all sides' cells.
inline constexpr int line_tasks = 16;
struct SideRange {
    std::size_t first = 0, last = 0;
};
SideRange side_range(const Enclosure& enclosure, int task);
// The side that a cell of all sides belongs to.
int side_of(const Enclosure& enclosure, std::size_t cell);

// Calls f(tracer, line) for each line of a range of cells, already traced.
template <class F>
void for_lines(const Enclosure& enclosure, const SideRange& range, LineTracer& tracer, F&& f) {
    for (std::size_t cell = range.first; cell < range.last; ++cell) {
        const int side = side_of(enclosure, cell);
        if (enclosure.sides[static_cast<std::size_t>(side)] == EnclosureSide::Mirror) continue;
        const auto in_side = static_cast<int>(cell - enclosure.first_side_cell(side));
        for (int i = 0; i < enclosure.lines; ++i) {
            const StartingLine line = starting_line(enclosure, side, in_side, i);
            tracer.trace(line.origin, line.direction, static_cast<int>(cell));
            f(tracer, line);
        }
    }
}

// Finds the patches of the surfaces in the enclosure by its own lines; `places` of each are kept.
// Throws Error{Usage} where a surface does not scatter evenly, naming it.
void find_patches(Enclosure& enclosure, int places);

}  // namespace gischt
