// SPDX-License-Identifier: Apache-2.0
// The one file that is compiled with OpenVDB: its files, with vdb_from_tree.h and vdb_to_tree.h its
// trees. What to make of the grids is decided in vdb_frame.cpp, vdb_grid.cpp, vdb_names.cpp.
#include "io/vdb.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "io/atomic_file.h"
#include "io/vdb_check.h"
#include "io/vdb_from_tree.h"
#include "io/vdb_grid.h"
#include "io/vdb_header.h"
#include "io/vdb_names.h"
#include "io/vdb_points.h"
#include "io/vdb_stamp.h"
#include "io/vdb_to_tree.h"

namespace gischt {

using namespace vdb_detail;

namespace {

// ---- calls into the library -----------------------------------------------------------

// A file that counts: a cancelled job stops inside of the library's long reads.
class WatchedFile : public std::filebuf {
  public:
    WatchedFile(const std::string& path, const Job& job) : job_(job) {
        open(path, std::ios::in | std::ios::binary);
    }

  protected:
    std::streamsize xsgetn(char* out, std::streamsize count) override {
        constexpr std::streamsize look_after = 1 << 22;  // bytes: some 10 ms of decompression
        unwatched_ += count;
        if (unwatched_ > look_after) {
            unwatched_ = 0;
            job_.check();
        }
        return std::filebuf::xsgetn(out, count);
    }

  private:
    const Job& job_;
    std::streamsize unwatched_ = 0;
};

// A grid of the file's type, with its transform and tree. Reading beyond the end of the file throws
// inside of the library, so that no loop and no allocation can outgrow the file by more than the
// 4 KiB to 512 KiB of a node.
openvdb::GridBase::Ptr read_tree(const std::string& path, const VdbHeader& header,
                                 const VdbEntry& entry, const Job& job) {
    WatchedFile file(path, job);
    std::istream in(&file);
    in.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    openvdb::io::setVersion(in, openvdb::VersionId(header.library_major, header.library_minor),
                            header.format);

    openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(entry.type);
    const VdbEntry& tree_entry =
        entry.parent < 0 ? entry : header.grids[static_cast<std::size_t>(entry.parent)];
    check_vdb_tree(path, tree_entry);
    grid->setSaveFloatAsHalf(tree_entry.is_half);
    openvdb::io::setDataCompression(in, tree_entry.compression);
    in.seekg(tree_entry.data);
    grid->readTransform(in);
    grid->readTopology(in);
    grid->readBuffers(in);
    if (entry.parent >= 0) {
        in.seekg(entry.data);
        grid->readTransform(in);
    }
    return grid;
}

// Runs `f` and turns whatever the library throws at a broken file into our error.
template <class F>
auto guarded(const std::string& path, const std::string& grid, F&& f) {
    const auto fail = [&](const std::string& why) {
        return Error(ErrorKind::Input, path, fmt::format("grid '{}' is broken ({})", grid, why),
                     "copy or write the file again");
    };
    try {
        return f();
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input || e.where() == path) throw;
        throw fail(e.fact());
    } catch (const std::ios_base::failure&) {
        throw fail("it reaches beyond the end of the file");
    } catch (const std::bad_alloc&) {
        // Its sizes have been found to fit its bytes.
        throw Error(ErrorKind::Resource, path,
                    fmt::format("grid '{}' does not fit into memory", grid));
    } catch (const std::exception& e) {
        throw fail(e.what());
    }
}

// The grid as what it is; nothing for types that have no place in a frame.
VdbTree parts_of(const openvdb::GridBase& grid, const std::string& name) {
    using namespace openvdb;
    VdbTree out;
    const auto take = [&]<class G>(const G*) {
        if (!grid.isType<G>()) return false;
        out = vdb_detail::parts_of(static_cast<const G&>(grid).tree(), name);
        return true;
    };
    const auto of = []<class G>() { return static_cast<const G*>(nullptr); };
    (void)(take(of.operator()<FloatGrid>()) || take(of.operator()<Vec3SGrid>()) ||
           take(of.operator()<DoubleGrid>()) || take(of.operator()<Vec3DGrid>()) ||
           take(of.operator()<Int32Grid>()) || take(of.operator()<Int64Grid>()) ||
           take(of.operator()<Vec3IGrid>()) || take(of.operator()<BoolGrid>()) ||
           take(of.operator()<MaskGrid>()));
    return out;
}

// Types that parts_of() knows, by their names in files.
bool is_known_type(const std::string& type) {
    using namespace openvdb;
    for (const auto& known : {FloatGrid::gridType(), Vec3SGrid::gridType(), DoubleGrid::gridType(),
                              Vec3DGrid::gridType(), Int32Grid::gridType(), Int64Grid::gridType(),
                              Vec3IGrid::gridType(), BoolGrid::gridType(), MaskGrid::gridType()}) {
        if (type == known) return true;
    }
    return false;
}

// Why a grid cannot be read, or nothing.
std::string why_not(const VdbEntry& entry) {
    if (entry.transform == "NonlinearFrustumMap") return "its transform is not affine";
    if (is_known_type(entry.type)) return {};
    if (is_point_type(entry.type)) {
        return "points that gischt did not write, or that were altered: points.foreign reads them";
    }
    return fmt::format("type '{}' has no place in a frame", entry.value_type());
}

// ---- reading --------------------------------------------------------------------------

// What the grids of one read share.
struct Reading {
    const std::string& path;
    Job& job;
    VdbBudget budget;
};

bool is_sound(const Transform& t) {
    const double d = t.determinant();
    return std::isfinite(d) && d != 0 && std::isfinite(dot(t.translation, t.translation));
}

FieldClass field_class(const std::string& name) {
    if (name == "level set") return FieldClass::LevelSet;
    return name == "unknown" ? FieldClass::Unknown : FieldClass::FogVolume;
}

// One grid of the file, or nothing where it has no place in a frame.
std::optional<VdbGrid> read_grid(const VdbHeader& header, const VdbEntry& entry, Reading& reading) {
    const auto skip = [&](const std::string& why) {
        reading.job.warn(fmt::format("{}: grid '{}' left out: {}", reading.path, entry.name, why));
        return std::nullopt;
    };
    if (const std::string why = why_not(entry); !why.empty()) return skip(why);
    const auto tree = guarded(reading.path, entry.name,
                              [&] { return read_tree(reading.path, header, entry, reading.job); });

    VdbGrid out;
    out.name = entry.name;
    out.metadata = entry.metadata;
    guarded(reading.path, entry.name,
            [&] { out.field.to_world = to_transform(tree->transform()); });
    if (!is_sound(out.field.to_world)) return skip("its transform has no inverse");
    out.field.kind = field_class(entry.grid_class());
    guarded(reading.path, entry.name, [&] {
        const VdbTree parts = parts_of(*tree, entry.name);
        out.is_staggered = parts.components == 3 && entry.grid_class() == "staggered";
        tree_to_field(parts, reading.budget, out);
    });
    return out;
}

bool is_wanted(const std::string& name, const std::string& customary,
               const std::vector<std::string>& wanted) {
    return wanted.empty() || std::ranges::find(wanted, name) != wanted.end() ||
           std::ranges::find(wanted, customary) != wanted.end();
}

// Indices of the entries to read; all components of a velocity that is asked for by that name.
std::vector<int> wanted_entries(const VdbHeader& header, const VdbReadOptions& options) {
    std::vector<VdbName> names;
    for (const VdbEntry& e : header.grids) {
        names.push_back({e.name, e.value_type().starts_with("vec3")});
    }
    std::vector<std::string> customary = customary_names(names, vdb_origin(header));
    if (const auto parts = velocity_components(names)) {
        for (const int p : *parts) customary[static_cast<std::size_t>(p)] = "velocity";
    }
    std::vector<int> out;
    for (std::size_t g = 0; g < names.size(); ++g) {
        const std::string& other = options.customary ? customary[g] : names[g].name;
        if (is_wanted(names[g].name, other, options.grids)) out.push_back(static_cast<int>(g));
    }
    return out;
}

// The grids of points. The library trusts what is in them, and their pages cannot be checked from
// outside: without leave only files are read that are to the last bit as gischt wrote them.
std::map<std::string, Particles> read_points(const std::string& path, const VdbHeader& header,
                                             bool trusts_all, std::vector<int>& wanted) {
    std::vector<int> points;
    for (const int w : wanted) {
        if (is_point_type(header.grids[static_cast<std::size_t>(w)].type)) points.push_back(w);
    }
    std::map<std::string, Particles> out;
    if (points.empty() || (!trusts_all && !has_vdb_stamp(path))) return out;
    std::erase_if(wanted, [&](int w) { return std::ranges::find(points, w) != points.end(); });
    openvdb::io::File file(path);
    for (const int p : points) {
        const VdbEntry& entry = header.grids[static_cast<std::size_t>(p)];
        out[entry.name] = guarded(path, entry.name, [&] {
            if (!file.isOpen()) file.open(false);
            return from_point_grid(*file.readGrid(entry.unique_name));
        });
    }
    return out;
}

// ---- looking --------------------------------------------------------------------------

// What the file itself says of a grid that the library does not know.
void describe_unknown(const VdbEntry& entry, VdbGridInfo& info) {
    const auto text = [&](const char* key) {
        const auto found = entry.metadata.find(key);
        return found == entry.metadata.end() ? std::string() : found->second;
    };
    std::sscanf(text("file_voxel_count").c_str(), "%" SCNd64, &info.active_voxels);
    std::sscanf(text("file_bbox_min").c_str(), "%d %d %d", &info.lo[0], &info.lo[1], &info.lo[2]);
    std::sscanf(text("file_bbox_max").c_str(), "%d %d %d", &info.hi[0], &info.hi[1], &info.hi[2]);
}

void describe_point_grid(const std::string& path, const VdbEntry& entry, VdbGridInfo& info) {
    guarded(path, entry.name, [&] {
        openvdb::io::File file(path);
        file.open(false);
        const auto grid = file.readGrid(entry.unique_name);
        const PointGridInfo points = describe_points(*grid);
        info.points = points.count;
        info.attributes = points.attributes;
        info.voxel_size.fill(grid->voxelSize().x());
    });
}

VdbGridInfo grid_info(const std::string& path, const VdbHeader& header, const VdbEntry& entry,
                      Job& job) {
    VdbGridInfo info;
    info.name = entry.name;
    info.type = entry.value_type();
    info.grid_class = entry.grid_class();
    info.is_half = entry.is_half;
    info.metadata = entry.metadata;
    info.note = why_not(entry);
    if (is_point_type(entry.type) && has_vdb_stamp(path)) info.note.clear();
    info.is_readable = info.note.empty();
    if (is_point_type(entry.type) && info.is_readable) {
        describe_unknown(entry, info);
        describe_point_grid(path, entry, info);
        return info;
    }
    if (!info.is_readable) {
        describe_unknown(entry, info);
        return info;
    }
    guarded(path, entry.name, [&] {
        const auto grid = read_tree(path, header, entry, job);
        describe_tree(parts_of(*grid, entry.name), info);
        const auto size = grid->voxelSize();
        const auto origin = grid->transform().indexToWorld(openvdb::Vec3d(0));
        info.voxel_size = {size.x(), size.y(), size.z()};
        info.origin = {origin.x(), origin.y(), origin.z()};
    });
    return info;
}

// ---- writing --------------------------------------------------------------------------

// The largest number that a half float holds.
constexpr float largest_half = 65504;

bool fits_half(const Field& field) {
    for (std::size_t c = 0; c < field.component.size(); ++c) {
        if (std::abs(field.background[c]) > largest_half) return false;
        const TileField<float>& values = field.component[c];
        const double largest = parallel_max(values.map().size(), 64, [&](int t) {
            double m = 0;
            for (int i = 0; i < tile_values; ++i) {
                m = std::max(m, std::abs(static_cast<double>(values.tile(t)[i])));
            }
            return m;
        });
        if (largest > largest_half) return false;
    }
    return true;
}

bool wants_half(const std::string& name, const Field& field, const VdbWriteOptions& options,
                Job& job) {
    if (field.kind == FieldClass::LevelSet) return false;
    if (!(field.is_vector() ? options.half_vectors : options.half_scalars)) return false;
    if (fits_half(field)) return true;
    job.info(
        fmt::format("field '{}' goes beyond {}: written as 32-bit floats", name, largest_half));
    return false;
}

openvdb::GridClass to_grid_class(FieldClass kind) {
    switch (kind) {
        case FieldClass::FogVolume:
            return openvdb::GRID_FOG_VOLUME;
        case FieldClass::LevelSet:
            return openvdb::GRID_LEVEL_SET;
        case FieldClass::Unknown:
            break;
    }
    return openvdb::GRID_UNKNOWN;
}

openvdb::GridBase::Ptr to_grid(const std::string& name, const Field& field,
                               const VdbWriteOptions& options, Job& job) {
    openvdb::GridBase::Ptr grid;
    if (field.is_vector()) {
        grid = to_tree<openvdb::Vec3SGrid>(field, job);
        // Transforms with the grid as a displacement does: a velocity.
        grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    } else {
        grid = to_tree<openvdb::FloatGrid>(field, job);
    }
    grid->setName(name);
    grid->setGridClass(to_grid_class(field.kind));
    grid->setTransform(from_transform(field.to_world, options.half_voxel));
    grid->setSaveFloatAsHalf(wants_half(name, field, options, job));
    return grid;
}

// What a reader cannot see in the tree: unit, 2-D tiles, the cells that carry meaning.
void add_grid_metadata(const std::string& name, const Frame& frame, openvdb::GridBase& grid) {
    const std::string prefix = name + ".";
    for (const auto& [key, value] : frame.metadata) {
        if (!key.starts_with(prefix) || key.size() == prefix.size()) continue;
        grid.insertMeta(key.substr(prefix.size()), openvdb::StringMetadata(value));
    }
    const std::string unit = unit_of(name, frame.metadata);
    if (!unit.empty()) grid.insertMeta("unit", openvdb::StringMetadata(unit));
    const TileMap& map = frame.find(name)->map();
    const auto triple = [](const Vec3i& v) {
        return openvdb::Vec3IMetadata(openvdb::Vec3i(v.x, v.y, v.z));
    };
    grid.insertMeta("gischt_bounds_min", triple(map.bounds().lo));
    grid.insertMeta("gischt_bounds_max", triple(map.bounds().hi));
    if (map.is_2d()) grid.insertMeta("gischt_2d", openvdb::BoolMetadata(true));
}

openvdb::MetaMap file_metadata(const Frame& frame) {
    openvdb::MetaMap out;
    for (const auto& [key, value] : frame.metadata) {
        const bool is_of_grid = frame.fields.contains(key.substr(0, key.find('.')));
        if (!key.empty() && !is_of_grid) out.insertMeta(key, openvdb::StringMetadata(value));
    }
    const auto set = [&](const char* key, const openvdb::Metadata& value) {
        out.removeMeta(key);  // which may be of another type
        out.insertMeta(key, value);
    };
    set("creator", openvdb::StringMetadata(fmt::format("gischt {}", version)));
    set("frame", openvdb::Int32Metadata(frame.number));
    set("seconds", openvdb::DoubleMetadata(frame.time));
    set("dt", openvdb::DoubleMetadata(frame.dt));
    out.removeMeta("fps");
    if (frame.dt > 0) out.insertMeta("fps", openvdb::DoubleMetadata(1 / frame.dt));
    return out;
}

// The edge of the voxels that particles are sorted into: of the cells that they became.
double point_voxel_size(const Frame& frame) {
    const Field* density = frame.find("density");
    return density ? density->cell_size() : 0.1;
}

void save(const std::string& file, const openvdb::GridCPtrVec& grids,
          const openvdb::MetaMap& metadata) {
    openvdb::io::File out(file);
    const bool has_blosc = openvdb::io::Archive::hasBloscCompression();
    out.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK |
                       (has_blosc ? openvdb::io::COMPRESS_BLOSC : openvdb::io::COMPRESS_ZIP));
    out.write(grids, metadata);
    out.close();
    stamp_vdb(file);
}

}  // namespace

Frame read_vdb(const std::string& path, const VdbReadOptions& options, Job& job) {
    const PhaseTimer timer(job, "read");
    openvdb::initialize();
    const VdbHeader header = read_vdb_header(path);
    std::vector<int> wanted = wanted_entries(header, options);
    auto particles = read_points(path, header, options.foreign_points, wanted);

    // Grids in parallel: decompression within one is serial in the library.
    Reading reading{path, job, {path, options.max_values}};
    std::vector<std::optional<VdbGrid>> read(wanted.size());
    std::atomic<int> done{0};
    const int count = static_cast<int>(wanted.size());
    parallel_for(count, 1, [&](int w) {
        const auto i = static_cast<std::size_t>(w);
        job.check();
        read[i] = read_grid(header, header.grids[static_cast<std::size_t>(wanted[i])], reading);
        job.progress(static_cast<double>(++done) / count, "read");
    });

    std::vector<VdbGrid> grids;
    for (auto& grid : read) {
        if (grid) grids.push_back(std::move(*grid));
    }
    const bool leaves_it_out = vdb_origin(header) == VdbOrigin::Mantaflow;
    if (options.half_voxel == HalfVoxel::Center ||
        (options.half_voxel == HalfVoxel::Auto && leaves_it_out)) {
        for (VdbGrid& grid : grids) shift_half_voxel(grid.field);
    }
    Frame frame = assemble_frame(std::move(grids), header, path, options.customary, job);
    frame.particles = std::move(particles);
    return frame;
}

VdbInfo list_vdb(const std::string& path, Job& job) {
    openvdb::initialize();
    const VdbHeader header = read_vdb_header(path);
    VdbInfo info;
    info.format = header.format;
    info.library = fmt::format("{}.{}", header.library_major, header.library_minor);
    info.metadata = header.metadata;
    for (const VdbEntry& entry : header.grids) {
        job.check();
        info.grids.push_back(grid_info(path, header, entry, job));
    }
    return info;
}

void write_vdb(const std::string& path, const Frame& frame, const VdbWriteOptions& options,
               Job& job) {
    const PhaseTimer timer(job, "write");
    openvdb::initialize();
    openvdb::GridCPtrVec grids;
    for (const auto& [name, field] : frame.fields) {
        job.check();
        const auto grid = to_grid(name, field, options, job);
        add_grid_metadata(name, frame, *grid);
        grids.push_back(grid);
        job.progress(
            0.5 * static_cast<double>(grids.size()) / static_cast<double>(frame.fields.size()),
            "write");
    }
    for (const auto& [name, particles] : frame.particles) {
        job.check();
        grids.push_back(to_point_grid(particles, name, point_voxel_size(frame)));
    }
    AtomicFile file(path);
    try {
        save(file.temporary(), grids, file_metadata(frame));
        read_vdb_header(file.temporary());  // a full disk may go unnoticed until here
    } catch (const std::exception& e) {
        throw Error(ErrorKind::Resource, path, fmt::format("writing failed ({})", e.what()),
                    "is the disk full?");
    }
    job.check();
    file.commit();
    job.progress(1, "write");
}

}  // namespace gischt
