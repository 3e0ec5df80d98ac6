// SPDX-License-Identifier: Apache-2.0
#include "solve/dense_inverse.h"

#include <cmath>
#include <numeric>
#include <unordered_map>

#include "solve/stencil_build.h"

namespace gischt {
namespace {

// A small symmetric matrix, row by row.
struct Matrix {
    std::size_t n;
    std::vector<double> a;
    explicit Matrix(std::size_t size) : n(size), a(size * size, 0.0) {}
    double& operator()(std::size_t i, std::size_t j) { return a[i * n + j]; }
};

// Value index of every cell that takes part, and of its neighbour over a face.
struct Cells {
    std::vector<int> value;
    std::vector<Vec3i> cell;
    std::vector<int> tile;
    std::unordered_map<int, std::size_t> number;

    explicit Cells(const StencilLevel& level) {
        for (const int t : level.active) {
            const Vec3i size = level.map->cells_of(t).size();
            for (int v = 0; v < tile_values; ++v) {
                const Vec3i c = level.shape().cell(v);
                if (c.x >= size.x || c.y >= size.y || c.z >= size.z) continue;
                const int at = split_index(level.shape(), c);
                if (!(level.block_of(t).inverse_diagonal[at / color_values][at % color_values] > 0))
                    continue;
                number[t * tile_values + at] = value.size();
                value.push_back(t * tile_values + at);
                cell.push_back(level.map->first_cell(t) + c);
                tile.push_back(t);
            }
        }
    }

    // Number of the neighbour of cell i, or -1 beyond the box.
    int neighbour(const StencilLevel& level, std::size_t i, int axis, int end) const {
        Vec3i c = cell[i];
        c[axis] += end == 0 ? -1 : 1;
        if (c[axis] < 0 || c[axis] >= level.cells[axis]) {
            const auto kind = level.sides[static_cast<std::size_t>(2 * axis)].kind;
            if (kind != SideRule::Kind::Periodic) return -1;
            c[axis] = (c[axis] + level.cells[axis]) % level.cells[axis];
        }
        const int t = level.map->find(level.shape().tile_of(c));
        const Vec3i local = c - level.map->first_cell(t);
        const auto found = number.find(t * tile_values + split_index(level.shape(), local));
        return found == number.end() ? -1 : static_cast<int>(found->second);
    }
};

std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// The operator, plus on each singular part a multiple of the projection on constants.
Matrix assemble(const StencilLevel& level, const Cells& cells) {
    const std::size_t n = cells.value.size();
    Matrix m(n);
    std::vector<std::size_t> parent(n);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    std::vector<char> held(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3i local = cells.cell[i] - level.map->first_cell(cells.tile[i]);
        const int at = split_index(level.shape(), local);
        const StencilBlock& block = level.block_of(cells.tile[i]);
        const double extra = static_cast<double>(block.extra[at / color_values][at % color_values]);
        m(i, i) += extra;
        held[i] = extra > 0;
        for (int a = 0; a < level.axes(); ++a) {
            for (int end = 0; end < 2; ++end) {
                const double w =
                    static_cast<double>(face_weight(level, cells.tile[i], local, a, end));
                if (w == 0) continue;
                m(i, i) += w;
                const int next = cells.neighbour(level, i, a, end);
                if (next < 0) {
                    held[i] = 1;
                } else {
                    m(i, static_cast<std::size_t>(next)) -= w;
                    parent[root(parent, i)] = root(parent, static_cast<std::size_t>(next));
                }
            }
        }
    }
    std::vector<double> size(n, 0), diagonal(n, 0);
    std::vector<char> part_held(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t p = root(parent, i);
        size[p] += 1;
        diagonal[p] += m(i, i);
        part_held[p] = part_held[p] != 0 || held[i] != 0;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t p = root(parent, i);
        if (part_held[p] != 0) continue;
        for (std::size_t j = 0; j < n; ++j) {
            if (root(parent, j) == p) m(i, j) += diagonal[p] / (size[p] * size[p]);
        }
    }
    return m;
}

// In-place inverse of a symmetric positive definite matrix by Gauss-Jordan, which needs no pivots
// there.
void invert(Matrix& m) {
    for (std::size_t k = 0; k < m.n; ++k) {
        const double pivot = 1 / m(k, k);
        m(k, k) = 1;
        for (std::size_t j = 0; j < m.n; ++j) m(k, j) *= pivot;
        for (std::size_t i = 0; i < m.n; ++i) {
            const double factor = m(i, k);
            if (i == k || factor == 0) continue;
            m(i, k) = 0;
            for (std::size_t j = 0; j < m.n; ++j) m(i, j) -= factor * m(k, j);
        }
    }
}

}  // namespace

DenseInverse::DenseInverse(const StencilLevel& level) {
    const Cells cells(level);
    value_ = cells.value;
    Matrix m = assemble(level, cells);
    invert(m);
    // The mean of both halves makes it symmetric to the last bit.
    inverse_.resize(m.a.size());
    for (std::size_t i = 0; i < m.n; ++i) {
        for (std::size_t j = 0; j < m.n; ++j) {
            inverse_[i * m.n + j] = static_cast<float>(0.5 * (m(i, j) + m(j, i)));
        }
    }
    r_.resize(m.n);
}

void DenseInverse::apply(const SplitField& r, SplitField& z) {
    const std::size_t n = value_.size();
    for (std::size_t i = 0; i < n; ++i) r_[i] = r.data()[value_[i]];
    for (std::size_t i = 0; i < n; ++i) {
        const float* row = inverse_.data() + i * n;
        // Eight partial sums: a fixed order that also fits vector units.
        float part[8] = {};
        std::size_t j = 0;
        for (; j + 8 <= n; j += 8) {
            for (std::size_t l = 0; l < 8; ++l) part[l] += row[j + l] * r_[j + l];
        }
        for (; j < n; ++j) part[0] += row[j] * r_[j];
        z.data()[value_[i]] = ((part[0] + part[1]) + (part[2] + part[3])) +
                              ((part[4] + part[5]) + (part[6] + part[7]));
    }
}

}  // namespace gischt
