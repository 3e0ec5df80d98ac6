// SPDX-License-Identifier: Apache-2.0
#include "render/zonal/enclosure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "math/sobol.h"

namespace gischt {

std::size_t Enclosure::first_side_cell(int side) const {
    std::size_t sum = 0;
    for (int s = 0; s < side; ++s) {
        const int u = (s / 2 + 1) % 3, v = (s / 2 + 2) % 3;
        sum += static_cast<std::size_t>(grid.cells[u]) * static_cast<std::size_t>(grid.cells[v]);
    }
    return sum;
}

std::uint64_t Enclosure::patch_key(const SurfaceHit& hit) const {
    const Vec3d n = abs(hit.normal);
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    const auto way = static_cast<std::uint64_t>(2 * axis + (hit.normal[axis] > 0 ? 1 : 0));
    // A surface between two zones belongs to the one that it faces.
    const Vec3d h = grid.cell_size();
    const Vec3i c = grid.cell_at(hit.point + 1e-3 * min_component(h) * hit.normal);
    return (static_cast<std::uint64_t>(hit.surface) * 6 + way) * grid.size() + grid.index(c);
}

int side_of(const Enclosure& enclosure, std::size_t cell) {
    int side = 0;
    while (cell >= enclosure.first_side_cell(side + 1)) ++side;
    return side;
}

SideRange side_range(const Enclosure& enclosure, int task) {
    const std::size_t n = enclosure.side_cells();
    const auto i = static_cast<std::size_t>(task), tasks = static_cast<std::size_t>(line_tasks);
    return {n * i / tasks, n * (i + 1) / tasks};
}

StartingLine starting_line(const Enclosure& enclosure, int side, int cell_in_side, int index) {
    const ZoneGrid& grid = enclosure.grid;
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool is_upper = side % 2 != 0;
    // Cells have other numbers than their neighbours, so that all directions come up; every fourth
    // has the same.
    const int across = cell_in_side % grid.cells[u], up = cell_in_side / grid.cells[u];
    const int tile = (across & 3) + 4 * (up & 3);
    const auto i = static_cast<std::uint32_t>(tile * enclosure.lines + index);
    const auto seed = static_cast<std::uint32_t>(side);
    const Vec2f place = sobol_2d(i, 2 * seed + 1), turn = sobol_2d(i, 2 * seed + 20);
    const Vec3d h = grid.cell_size();
    StartingLine line;
    line.origin[axis] = is_upper ? grid.box.hi[axis] : grid.box.lo[axis];
    line.origin[u] = grid.box.lo[u] + h[u] * (across + static_cast<double>(place.x));
    line.origin[v] = grid.box.lo[v] + h[v] * (up + static_cast<double>(place.y));
    const double sine = std::sqrt(static_cast<double>(turn.x));
    const double angle = 2 * pi * static_cast<double>(turn.y);
    line.direction[axis] = (is_upper ? -1 : 1) * std::sqrt(1 - sine * sine);
    line.direction[u] = sine * std::cos(angle);
    line.direction[v] = sine * std::sin(angle);
    line.weight = static_cast<float>(0.5 * pi * h[u] * h[v] / enclosure.lines);
    return line;
}

// The zones from a point on, with mirrors. Returns the cell of all sides at which it leaves, or -1
// where it ends inside.
int LineTracer::walk(const Vec3d& from, const Vec3d& direction, double t_end) {
    constexpr int most_crossings = 10'000'000;
    const ZoneGrid& grid = enclosure_.grid;
    const Vec3d h = grid.cell_size();
    Vec3i c = grid.cell_at(from), way;
    Vec3d next, step;
    for (int a = 0; a < 3; ++a) {
        const double d = direction[a];
        way[a] = d > 0 ? 1 : -1;
        step[a] = d == 0 ? 0 : h[a] / std::abs(d);
        const double wall = grid.box.lo[a] + (c[a] + (d > 0 ? 1 : 0)) * h[a];
        next[a] =
            d == 0 ? std::numeric_limits<double>::infinity() : std::max((wall - from[a]) / d, 0.0);
    }
    double t = 0;
    std::uint8_t flips = 0;
    for (int i = 0; i < most_crossings; ++i) {
        const int a = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
        const double end = std::min(next[a], t_end);
        if (end > t) {
            crossings.push_back(
                {static_cast<std::uint32_t>(grid.index(c)), static_cast<float>(end - t), flips});
        }
        if (next[a] >= t_end) return -1;
        t = end;
        next[a] += step[a];
        const int beyond = c[a] + way[a];
        if (beyond >= 0 && beyond < grid.cells[a]) {
            c[a] = beyond;
            continue;
        }
        const int side = 2 * a + (way[a] > 0 ? 1 : 0);
        if (enclosure_.sides[static_cast<std::size_t>(side)] == EnclosureSide::Mirror) {
            way[a] = -way[a];
            flips = static_cast<std::uint8_t>(flips ^ (1 << a));
            continue;
        }
        const int u = (a + 1) % 3, v = (a + 2) % 3;
        return static_cast<int>(enclosure_.first_side_cell(side)) + c[u] + grid.cells[u] * c[v];
    }
    throw Error(ErrorKind::Usage, "zonal", "light never leaves an enclosure of mirrors",
                "leave a side open");
}

int LineTracer::patch_at(const SurfaceHit& hit) const {
    if (note) return note(context, hit);
    const auto found = enclosure_.patch_of_key.find(enclosure_.patch_key(hit));
    return found == enclosure_.patch_of_key.end() ? -1 : found->second;
}

void LineTracer::trace(const Vec3d& origin, const Vec3d& direction, int cell) {
    crossings.clear();
    pieces.clear();
    LinePiece piece;
    piece.from_cell = cell;
    if (!enclosure_.surfaces || enclosure_.surfaces->is_empty()) {
        piece.to_cell = walk(origin, direction, std::numeric_limits<double>::infinity());
        piece.last = crossings.size();
        pieces.push_back(piece);
        return;
    }
    Ray ray{origin, direction};
    ray.t_max = clip(ray, enclosure_.grid.box).t1;
    bool is_inside = false;  // of a solid
    constexpr int most_pieces = 256;
    for (int i = 0; i < most_pieces; ++i) {
        const auto hit = enclosure_.surfaces->intersect(ray);
        const bool is_sheet = hit && enclosure_.surfaces->info(hit->surface).is_sheet;
        // A solid that is left was entered before, if not on this line then before it began.
        const bool is_solid = is_inside || (hit && !is_sheet && !hit->front);
        piece.first = crossings.size();
        if (!is_solid) {
            piece.to_cell =
                walk(ray.origin, direction, hit ? hit->t : std::numeric_limits<double>::infinity());
            piece.to_patch = hit ? patch_at(*hit) : -1;
            piece.last = crossings.size();
            pieces.push_back(piece);
        }
        if (!hit) return;
        if (!is_sheet) is_inside = hit->front;
        // The other side of the surface, where the next piece begins.
        SurfaceHit behind = *hit;
        behind.normal = -hit->normal;
        behind.front = !hit->front;
        piece = {};
        piece.from_patch = is_inside ? -1 : patch_at(behind);
        const double left = ray.t_max - hit->t;
        ray = leaving_ray(*hit, direction);
        ray.t_max = left;
        if (!(left > 0)) return;
    }
}

namespace {

// Fills patches while lines are followed.
struct PatchFinder {
    Enclosure& enclosure;
    int most_places;

    static int note(void* context, const SurfaceHit& hit) {
        return static_cast<PatchFinder*>(context)->add(hit);
    }
    int add(const SurfaceHit& hit) {
        const auto [found, is_new] = enclosure.patch_of_key.try_emplace(
            enclosure.patch_key(hit), static_cast<int>(enclosure.patches.size()));
        if (is_new) {
            enclosure.patches.emplace_back();
            enclosure.patches.back().surface = hit.surface;
        }
        SurfacePatch& p = enclosure.patches[static_cast<std::size_t>(found->second)];
        p.center += hit.point;
        p.normal += hit.normal;
        p.albedo += hit.albedo;
        // Each hit is kept with the same chance (reservoir sampling, Vitter 1985).
        ++p.hits;
        const auto most = static_cast<std::size_t>(most_places);
        if (p.places.size() < most) {
            p.places.push_back(hit);
        } else {
            const std::uint64_t number = random_key(static_cast<std::uint64_t>(found->second),
                                                    static_cast<std::uint64_t>(p.hits)) %
                                         static_cast<std::uint64_t>(p.hits);
            if (number < most) p.places[number] = hit;
        }
        return found->second;
    }
};

}  // namespace

void find_patches(Enclosure& enclosure, int places) {
    enclosure.patches.clear();
    enclosure.patch_of_key.clear();
    if (!enclosure.surfaces || enclosure.surfaces->is_empty()) return;
    PatchFinder finder{enclosure, places};
    LineTracer tracer(enclosure);
    tracer.note = PatchFinder::note;
    tracer.context = &finder;
    for_lines(enclosure, {0, enclosure.side_cells()}, tracer,
              [](const LineTracer&, const StartingLine&) {});
    for (SurfacePatch& p : enclosure.patches) {
        p.center = p.center / Vec3d(p.hits);
        const double l = length(p.normal);
        p.normal = l > 0 ? p.normal / l : Vec3d(0, 0, 1);
        p.albedo = p.albedo / Vec3f(static_cast<float>(p.hits));
    }
}

}  // namespace gischt
