// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "io/vdb_bytes.h"

namespace gischt {

namespace {

constexpr std::uint64_t vdb_magic = 0x56444220;  // " BDV" in the file
constexpr std::uint32_t oldest_format = 222;     // OpenVDB 3: compression flags of each grid
constexpr std::uint32_t newest_format = 224;     // OpenVDB 4 to 12
constexpr std::size_t uuid_length = 36;
constexpr char unique_separator = 30;  // between a name and its number

template <class T>
std::string components(VdbBytes& in, int count) {
    std::string out;
    for (int c = 0; c < count; ++c) {
        if (c > 0) out += ' ';
        out += fmt::format("{}", in.number<T>());
    }
    return out;
}

// The value of one metadatum as text; empty for types that mean nothing outside of the library.
std::string metadata_value(VdbBytes& in, const std::string& type, std::uint32_t length) {
    const auto is = [&](const char* name, std::size_t size) {
        return type == name && length == size;
    };
    if (type == "string") return in.text(length);
    if (is("bool", 1)) return in.number<char>() ? "true" : "false";
    if (is("int32", 4)) return components<std::int32_t>(in, 1);
    if (is("int64", 8)) return components<std::int64_t>(in, 1);
    if (is("float", 4)) return components<float>(in, 1);
    if (is("double", 8)) return components<double>(in, 1);
    for (int n = 2; n <= 4; ++n) {
        const auto size = static_cast<std::size_t>(n);
        if (is(fmt::format("vec{}i", n).c_str(), 4 * size)) return components<std::int32_t>(in, n);
        if (is(fmt::format("vec{}s", n).c_str(), 4 * size)) return components<float>(in, n);
        if (is(fmt::format("vec{}d", n).c_str(), 8 * size)) return components<double>(in, n);
    }
    in.skip(length);
    return {};
}

std::map<std::string, std::string> read_metadata(VdbBytes& in) {
    std::map<std::string, std::string> out;
    const auto count = in.number<std::uint32_t>();
    for (std::uint32_t n = 0; n < count; ++n) {
        const std::string name = in.text(), type = in.text();
        const auto length = in.number<std::uint32_t>();
        const std::string value = metadata_value(in, type, length);
        if (!value.empty()) out[name] = value;
    }
    return out;
}

// What the file is instead, for the most likely confusions.
void refuse_other_kinds(const VdbBytes& in, const std::string& start) {
    if (start.starts_with("NanoVDB")) {
        in.fail("this is a NanoVDB file, which gischt does not read",
                "convert it: nanovdb_convert in.nvdb out.vdb (from the OpenVDB package)");
    }
    const std::pair<const char*, const char*> kinds[] = {{"\x89PNG", "a PNG image"},
                                                         {"v/1\x01", "an OpenEXR image"},
                                                         {"\x1f\x8b", "gzip-compressed data"},
                                                         {"PK\x03\x04", "a zip archive"},
                                                         {"\x89HDF", "an HDF5 file"}};
    for (const auto& [magic, kind] : kinds) {
        if (start.starts_with(magic)) in.fail(fmt::format("not a VDB file but {}", kind));
    }
    in.fail("not a VDB file", "a VDB file begins with the bytes 20 42 44 56");
}

void read_prologue(VdbBytes& in, VdbHeader& header) {
    const std::string start =
        in.text(static_cast<std::uint64_t>(std::min<std::int64_t>(8, in.size())));
    if (start.empty()) in.fail("the file is empty");
    std::uint64_t magic = 0;
    if (start.size() == 8) std::memcpy(&magic, start.data(), 8);
    if (magic != vdb_magic) refuse_other_kinds(in, start);

    header.format = in.number<std::uint32_t>();
    header.library_major = in.number<std::uint32_t>();
    header.library_minor = in.number<std::uint32_t>();
    if (header.format < oldest_format || header.format > newest_format) {
        in.fail(fmt::format("VDB file format {} is not supported (only {} to {})", header.format,
                            oldest_format, newest_format),
                "write the file again with a program of today");
    }
    const bool has_offsets = in.number<char>() != 0;
    in.text(uuid_length);
    if (!has_offsets) {
        in.fail("the file was written as a stream, without a table of contents",
                "write it again with openvdb::io::File or any 3-D program");
    }
}

VdbEntry read_descriptor(VdbBytes& in, std::string& parent) {
    constexpr std::string_view half = "_HalfFloat";
    VdbEntry entry;
    entry.unique_name = in.text();
    entry.name = entry.unique_name.substr(0, entry.unique_name.find(unique_separator));
    entry.type = in.text();
    if (entry.type.ends_with(half)) {
        entry.is_half = true;
        entry.type.resize(entry.type.size() - half.size());
    }
    parent = in.text();
    entry.begin = in.number<std::int64_t>();
    in.number<std::int64_t>();  // where the voxel values begin
    entry.end = in.number<std::int64_t>();
    if (entry.begin < in.position() || entry.end < entry.begin) {
        in.fail(fmt::format("the place of grid '{}' in the file makes no sense", entry.name));
    }
    if (entry.end > in.size()) in.fail_short();
    return entry;
}

}  // namespace

std::string VdbEntry::value_type() const {
    const std::size_t first = type.find('_');
    if (first == std::string::npos) return type;
    const std::size_t second = type.find('_', first + 1);
    return type.substr(first + 1, second == std::string::npos ? second : second - first - 1);
}

std::string VdbEntry::grid_class() const {
    const auto found = metadata.find("class");
    return found == metadata.end() ? "unknown" : found->second;
}

VdbHeader read_vdb_header(const std::string& path) {
    // Prologue and metadata of the file, then the table of contents; OpenVDB writes a grid's
    // descriptor right before its data, so the next one is found at its end.
    VdbBytes in(path);
    VdbHeader header;
    header.size = in.size();
    read_prologue(in, header);
    header.metadata = read_metadata(in);
    const auto count = in.number<std::int32_t>();
    if (count < 0) in.fail("the number of grids is negative");
    std::map<std::string, int> index;
    for (int n = 0; n < count; ++n) {
        std::string parent;
        VdbEntry entry = read_descriptor(in, parent);
        if (!parent.empty()) {
            const auto found = index.find(parent);
            if (found == index.end()) {
                in.fail(fmt::format("grid '{}' shares the tree of '{}', which is not there",
                                    entry.name, parent));
            }
            entry.parent = found->second;
        }
        in.seek(entry.begin);
        entry.compression = in.number<std::uint32_t>();
        entry.metadata = read_metadata(in);
        entry.data = in.position();
        entry.transform = in.text();
        if (entry.data > entry.end) in.fail_short();
        index.emplace(entry.unique_name, n);
        in.seek(entry.end);
        header.grids.push_back(std::move(entry));
    }
    return header;
}

}  // namespace gischt
