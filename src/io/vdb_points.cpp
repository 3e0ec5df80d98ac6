// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_points.h"

#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/PointIndexGrid.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace gischt::vdb_detail {
namespace {

using openvdb::points::PointDataGrid;
using openvdb::tools::PointIndexGrid;

std::vector<std::size_t> order_by_id(const Particles& p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p.id[i]; });
    return order;
}

// Adds an array of one value per point as an attribute of type V.
template <class V, class T, class F>
void add(PointDataGrid& grid, const PointIndexGrid& index, const char* name,
         const std::vector<T>& values, const std::vector<std::size_t>& order, F&& convert) {
    if (values.empty()) return;
    std::vector<V> out;
    out.reserve(values.size());
    for (const std::size_t i : order) out.push_back(convert(values[i]));
    openvdb::points::appendAttribute<V>(grid.tree(), name);
    const openvdb::points::PointAttributeVector<V> wrapper(out);
    openvdb::points::populateAttribute(grid.tree(), index.tree(), name, wrapper);
}

openvdb::Vec3f to_vdb(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

Vec3f from_vdb(const openvdb::Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

// Calls set(value) for the points of a leaf where it has such an attribute.
template <class V, class Leaf, class F>
void take(const Leaf& leaf, const char* name, F&& set) {
    if (leaf.attributeSet().find(name) == openvdb::points::AttributeSet::INVALID_POS) return;
    const openvdb::points::AttributeHandle<V> handle(leaf.constAttributeArray(name));
    for (auto i = leaf.beginIndexOn(); i; ++i) set(handle.get(*i));
}

// Which of the arrays that may be empty a grid has, and how wide its ids are.
struct Looks {
    bool color, opacity, temperature, id, short_id;
};

// Appends what one leaf holds.
template <class Leaf>
void take_leaf(const Leaf& leaf, const openvdb::math::Transform& transform, const Looks& looks,
               Particles& out) {
    const std::size_t first = out.size();
    const openvdb::points::AttributeHandle<openvdb::Vec3f> place(leaf.constAttributeArray("P"));
    for (auto i = leaf.beginIndexOn(); i; ++i) {
        const auto world =
            transform.indexToWorld(openvdb::Vec3d(place.get(*i)) + i.getCoord().asVec3d());
        out.position.emplace_back(world.x(), world.y(), world.z());
        if (!world.isFinite()) throw std::runtime_error("a position is not finite");
    }
    const std::size_t count = out.position.size();
    out.velocity.resize(count);
    out.age.resize(count);
    out.life.resize(count, std::numeric_limits<float>::infinity());
    out.radius.resize(count, 0.01f);
    out.id.resize(count);
    if (looks.color) out.color.resize(count);
    if (looks.opacity) out.opacity.resize(count);
    if (looks.temperature) out.temperature.resize(count);

    const auto into = [first](auto& array, auto convert) {
        return [&array, convert, at = first](const auto& v) mutable { array[at++] = convert(v); };
    };
    const auto same = [](const auto& v) { return v; };
    const auto whole = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
    take<openvdb::Vec3f>(leaf, "v", into(out.velocity, from_vdb));
    take<float>(leaf, "age", into(out.age, same));
    take<float>(leaf, "life", into(out.life, same));
    take<float>(leaf, "pscale", into(out.radius, same));
    if (looks.short_id) {
        take<std::int32_t>(leaf, "id", into(out.id, whole));
    } else if (looks.id) {
        take<std::int64_t>(leaf, "id", into(out.id, whole));
    } else {
        std::iota(out.id.begin() + static_cast<std::ptrdiff_t>(first), out.id.end(), first);
    }
    if (looks.color) take<openvdb::Vec3f>(leaf, "Cd", into(out.color, from_vdb));
    if (looks.opacity) take<float>(leaf, "Alpha", into(out.opacity, same));
    if (looks.temperature) take<float>(leaf, "temperature", into(out.temperature, same));
}

}  // namespace

bool is_point_type(const std::string& type) {
    return type == PointDataGrid::gridType();
}

openvdb::GridBase::Ptr to_point_grid(const Particles& particles, const std::string& name,
                                     double voxel_size) {
    const auto order = order_by_id(particles);
    std::vector<openvdb::Vec3d> positions;
    positions.reserve(particles.size());
    for (const std::size_t i : order) {
        const Vec3d& p = particles.position[i];
        positions.emplace_back(p.x, p.y, p.z);
    }
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel_size);
    const openvdb::points::PointAttributeVector<openvdb::Vec3d> wrapper(positions);
    const auto index = openvdb::tools::createPointIndexGrid<PointIndexGrid>(wrapper, *transform);
    const auto grid =
        openvdb::points::createPointDataGrid<openvdb::points::NullCodec, PointDataGrid>(
            *index, wrapper, *transform);
    grid->setName(name);
    if (particles.is_empty()) return grid;

    const auto same = [](float v) { return v; };
    add<openvdb::Vec3f>(*grid, *index, "v", particles.velocity, order, to_vdb);
    add<float>(*grid, *index, "age", particles.age, order, same);
    add<float>(*grid, *index, "life", particles.life, order, same);
    add<float>(*grid, *index, "pscale", particles.radius, order, same);
    add<std::int64_t>(*grid, *index, "id", particles.id, order,
                      [](std::uint64_t v) { return static_cast<std::int64_t>(v); });
    add<openvdb::Vec3f>(*grid, *index, "Cd", particles.color, order, to_vdb);
    add<float>(*grid, *index, "Alpha", particles.opacity, order, same);
    add<float>(*grid, *index, "temperature", particles.temperature, order, same);
    return grid;
}

Particles from_point_grid(const openvdb::GridBase& grid) {
    const auto& points = dynamic_cast<const PointDataGrid&>(grid);
    Particles out;
    const auto first = points.tree().cbeginLeaf();
    if (!first) return out;
    const auto has = [&](const char* name) {
        return first->attributeSet().find(name) != openvdb::points::AttributeSet::INVALID_POS;
    };
    const bool has_short_id =
        has("id") && first->constAttributeArray("id").hasValueType<std::int32_t>();
    const Looks looks{has("Cd"), has("Alpha"), has("temperature"), has("id"), has_short_id};
    for (auto leaf = points.tree().cbeginLeaf(); leaf; ++leaf) {
        take_leaf(*leaf, points.transform(), looks, out);
    }
    const auto order = order_by_id(out);
    for_all_particle_arrays(out, [&](auto& array) {
        const auto unsorted = array;
        for (std::size_t i = 0; i < array.size(); ++i) array[i] = unsorted[order[i]];
    });
    return out;
}

PointGridInfo describe_points(const openvdb::GridBase& grid) {
    const auto& points = dynamic_cast<const PointDataGrid&>(grid);
    PointGridInfo info;
    info.count = static_cast<std::int64_t>(openvdb::points::pointCount(points.tree()));
    const auto first = points.tree().cbeginLeaf();
    if (!first) return info;
    for (const auto& [name, place] : first->attributeSet().descriptor().map()) {
        if (name != "P") info.attributes.push_back(name);
    }
    std::ranges::sort(info.attributes);
    return info;
}

}  // namespace gischt::vdb_detail
