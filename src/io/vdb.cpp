// SPDX-License-Identifier: Apache-2.0
// The one file that is compiled with OpenVDB: its files, with vdb_from_tree.h and vdb_to_tree.h its
// trees. What to make of the grids is decided in vdb_frame.cpp, vdb_grid.cpp, vdb_names.cpp.
#include "io/vdb.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <optional>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/version.h"
#include "io/atomic_file.h"
#include "io/vdb_from_tree.h"
#include "io/vdb_grid.h"
#include "io/vdb_header.h"
#include "io/vdb_names.h"
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
    } catch (const Error&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw fail("it reaches beyond the end of the file");
    } catch (const std::bad_alloc&) {
        throw fail("it asks for more memory than there is");
    } catch (const std::exception& e) {
        throw fail(e.what());
    }
}

// Calls f with the grid as what it is; false for types that have no place in a frame.
template <class F>
bool visit(const openvdb::GridBase& grid, F&& f) {
    const auto as = [&]<class G>(const G*) {
        if (!grid.isType<G>()) return false;
        f(static_cast<const G&>(grid));
        return true;
    };
    using namespace openvdb;
    return as(static_cast<FloatGrid*>(nullptr)) || as(static_cast<Vec3SGrid*>(nullptr)) ||
           as(static_cast<DoubleGrid*>(nullptr)) || as(static_cast<Vec3DGrid*>(nullptr)) ||
           as(static_cast<Int32Grid*>(nullptr)) || as(static_cast<Int64Grid*>(nullptr)) ||
           as(static_cast<Vec3IGrid*>(nullptr)) || as(static_cast<BoolGrid*>(nullptr)) ||
           as(static_cast<MaskGrid*>(nullptr));
}

// Types that visit() knows, by their names in files.
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
    if (is_known_type(entry.type)) return {};
    return fmt::format("type '{}' has no place in a frame", entry.value_type());
}

// ---- reading --------------------------------------------------------------------------

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
    if (!tree->transform().isLinear()) return skip("its transform is not affine");

    VdbGrid out;
    out.name = entry.name;
    out.metadata = entry.metadata;
    out.field.to_world = to_transform(tree->transform());
    if (!is_sound(out.field.to_world)) return skip("its transform has no inverse");
    out.field.kind = field_class(entry.grid_class());
    guarded(reading.path, entry.name, [&] {
        visit(*tree, [&](const auto& grid) {
            using Value = typename std::decay_t<decltype(grid)>::ValueType;
            out.is_staggered = components_of<Value> == 3 && entry.grid_class() == "staggered";
            to_tiles(grid, reading, out);
        });
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

}  // namespace

Frame read_vdb(const std::string& path, const VdbReadOptions& options, Job& job) {
    const PhaseTimer timer(job, "read");
    openvdb::initialize();
    const VdbHeader header = read_vdb_header(path);
    const std::vector<int> wanted = wanted_entries(header, options);

    // Grids in parallel: decompression within one is serial in the library.
    Reading reading{path, options, job};
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
    return assemble_frame(std::move(grids), header, path, options.customary, job);
}

}  // namespace gischt
