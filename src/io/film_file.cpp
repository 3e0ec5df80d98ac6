// SPDX-License-Identifier: Apache-2.0
#include "io/film_file.h"

#include <fmt/format.h>

#include <bit>
#include <filesystem>

#include "base/error.h"
#include "base/hash.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"

namespace gischt {
namespace {

constexpr std::string_view film_magic = "gischt film\n";
constexpr std::uint32_t film_version = 1;
constexpr std::size_t sums_per_pixel = 9;  // of a FilmPixel

__extension__ typedef unsigned __int128 UInt128;

struct FilmWriter {
    std::string bytes;

    template <class T>
    void number(T value) {  // unsigned
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            bytes.push_back(static_cast<char>(value >> (8 * i) & 0xff));
        }
    }
    void u32(std::size_t value) { number(static_cast<std::uint32_t>(value)); }
    void i32(std::int32_t value) { number(static_cast<std::uint32_t>(value)); }
    void text(const std::string& s) {
        u32(s.size());
        bytes += s;
    }
    void sum(Int128 value) {
        const UInt128 u =
            static_cast<UInt128>(value) << 1 ^ static_cast<UInt128>(value < 0 ? -1 : 0);
        if (u == 0) {
            bytes.push_back('\xff');
            return;
        }
        std::uint8_t b[16];
        for (int i = 0; i < 16; ++i) b[i] = static_cast<std::uint8_t>(u >> (8 * i));
        int first = 0, last = 15;
        while (b[first] == 0) ++first;
        while (b[last] == 0) --last;
        bytes.push_back(static_cast<char>(first << 4 | (last - first)));
        for (int i = first; i <= last; ++i) bytes.push_back(static_cast<char>(b[i]));
    }
};

// Reads what FilmWriter wrote; throws Error{Input} at the end of the bytes.
struct FilmReader {
    const std::string& path;
    std::string_view rest;

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::Input, path, what, "remove it, or take --restart");
    }
    std::string_view take(std::size_t count) {
        if (count > rest.size()) fail("is a film file that is cut short");
        const std::string_view part = rest.substr(0, count);
        rest.remove_prefix(count);
        return part;
    }
    template <class T>
    T number() {
        const std::string_view part = take(sizeof(T));
        T value = 0;
        for (std::size_t i = sizeof(T); i-- > 0;) {
            value = static_cast<T>(value << 8 | static_cast<std::uint8_t>(part[i]));
        }
        return value;
    }
    std::uint8_t byte() { return static_cast<std::uint8_t>(take(1)[0]); }
    std::uint32_t u32() { return number<std::uint32_t>(); }
    std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
    // A count of things of at least `size` bytes each.
    std::uint32_t count(std::size_t size) {
        const std::uint32_t n = u32();
        if (n > rest.size() / size) fail("is a film file that is cut short");
        return n;
    }
    std::string text() { return std::string(take(count(1))); }
    Int128 sum() {
        const std::uint8_t head = byte();
        if (head == 0xff) return 0;
        const int first = head >> 4, size = (head & 15) + 1;
        if (first + size > 16) fail("is a damaged film file");
        const std::string_view part = take(static_cast<std::size_t>(size));
        UInt128 u = 0;
        for (int i = size; i-- > 0;) {
            u = u << 8 | static_cast<std::uint8_t>(part[static_cast<std::size_t>(i)]);
        }
        u <<= 8 * first;
        return static_cast<Int128>(u >> 1) ^ -static_cast<Int128>(u & 1);
    }
};

void put_pixel(FilmWriter& out, const FilmPixel& p) {
    out.i32(p.count);
    out.i32(p.hits);
    out.i32(p.rejected);
    for (const ExactSum& s : p.radiance) out.sum(s.units());
    for (const ExactSum* s : {&p.alpha, &p.weight, &p.luminance, &p.depth}) out.sum(s->units());
    out.sum(p.luminance_2.coarse_units());
    out.sum(p.luminance_2.fine_units());
}

void get_pixel(FilmReader& in, FilmPixel& p) {
    p.count = in.i32();
    p.hits = in.i32();
    p.rejected = in.i32();
    const bool is_sound = p.count >= 0 && p.count <= 1 << 24 && p.hits >= 0 && p.rejected >= 0 &&
                          p.hits <= p.count && p.rejected <= p.count;
    if (!is_sound) in.fail("is a damaged film file");
    for (ExactSum& s : p.radiance) s.set_units(in.sum());
    for (ExactSum* s : {&p.alpha, &p.weight, &p.luminance, &p.depth}) s->set_units(in.sum());
    const Int128 coarse = in.sum();
    p.luminance_2.set_units(coarse, static_cast<std::uint64_t>(in.sum()));
}

void put_header(FilmWriter& out, const FilmState& state, const Metadata& metadata) {
    const Film& film = *state.film;
    out.bytes += film_magic;
    out.u32(film_version);
    out.u32(static_cast<std::size_t>(film.width()));
    out.u32(static_cast<std::size_t>(film.height()));
    out.u32(static_cast<std::size_t>(film.filter().kind()));
    out.number(std::bit_cast<std::uint32_t>(film.filter().radius()));
    out.u32(film.extra_names().size());
    for (const std::string& name : film.extra_names()) out.text(name);
    out.u32(state.ranges.size());
    for (const SampleRange r : state.ranges) {
        out.i32(r.begin);
        out.i32(r.end);
    }
    out.u32(state.tile_goals.size());
    for (const std::int32_t goal : state.tile_goals) out.i32(goal);
    out.number(static_cast<std::uint8_t>(
        (state.has_variance ? 1 : 0) | (state.has_samples ? 2 : 0) | (film.has_splats() ? 4 : 0)));
    out.u32(metadata.entries.size());
    for (const auto& [key, value] : metadata.entries) {
        out.text(key);
        out.text(value);
    }
}

FilmFile get_header(FilmReader& in) {
    FilmFile file;
    const std::uint32_t width = in.u32(), height = in.u32(), kind = in.u32();
    const auto radius = std::bit_cast<float>(in.u32());
    std::vector<std::string> extra(in.count(4));
    for (std::string& name : extra) name = in.text();
    file.state.ranges.resize(in.count(8));
    int last = 0;
    for (SampleRange& r : file.state.ranges) {
        r.begin = in.i32();
        r.end = in.i32();
        if (r.begin < last || r.end <= r.begin) in.fail("is a damaged film file");
        last = r.end;
    }
    file.state.tile_goals.resize(in.count(4));
    for (std::int32_t& goal : file.state.tile_goals) goal = in.i32();
    const std::uint8_t flags = in.byte();
    file.state.has_variance = (flags & 1) != 0;
    file.state.has_samples = (flags & 2) != 0;
    const std::uint32_t entries = in.count(8);
    for (std::uint32_t i = 0; i < entries; ++i) {
        std::string key = in.text();
        file.metadata.entries.emplace_back(std::move(key), in.text());
    }

    // No more memory than the bytes that are there can fill.
    const std::size_t per_pixel = 12 + sums_per_pixel + extra.size();
    const bool is_sound = width >= 1 && height >= 1 && width <= 65536 && height <= 65536 &&
                          kind <= static_cast<std::uint32_t>(FilterKind::BlackmanHarris) &&
                          radius > 0 && radius <= 16 &&
                          std::uint64_t{width} * height <= in.rest.size() / per_pixel;
    if (!is_sound) in.fail("is a damaged film file");
    file.state.film.emplace(static_cast<int>(width), static_cast<int>(height),
                            ReconstructionFilter(static_cast<FilterKind>(kind), radius),
                            std::move(extra));
    if ((flags & 4) != 0) file.state.film->want_splats();
    return file;
}

}  // namespace

void write_film(const std::string& path, const FilmState& state, const Metadata& metadata) {
    AtomicFile file(path);
    const Film& film = *state.film;
    FilmWriter out;
    put_header(out, state, metadata);
    const std::size_t extras = film.extra_names().size();
    for (std::size_t i = 0; i < film.pixels().size(); ++i) {
        put_pixel(out, film.pixels()[i]);
        for (const ExactSum& s : film.extra_sums().subspan(i * extras, extras)) out.sum(s.units());
    }
    if (film.has_splats()) {
        out.number(static_cast<std::uint64_t>(film.light_paths()));
        for (const ExactSum& s : film.splat_sums()) out.sum(s.units());
    }
    out.number(hash_bytes(out.bytes));
    file.write(std::span<const char>(out.bytes));
    file.commit();
}

FilmFile read_film(const std::string& path) {
    const std::string bytes = read_bytes(path);
    FilmReader in{path, bytes};
    if (!in.rest.starts_with(film_magic)) in.fail("is no film file");
    in.take(film_magic.size());
    if (const std::uint32_t version = in.u32(); version != film_version) {
        in.fail(fmt::format("is a film file of version {}, this program knows {}", version,
                            film_version));
    }
    if (in.rest.size() < 8) in.fail("is a film file that is cut short");
    FilmReader tail{path, in.rest.substr(in.rest.size() - 8)};
    in.rest.remove_suffix(8);
    if (tail.number<std::uint64_t>() !=
        hash_bytes(std::string_view(bytes).substr(0, bytes.size() - 8))) {
        in.fail("is a film file that is cut short or damaged");
    }
    FilmFile file = get_header(in);
    Film& film = *file.state.film;
    const std::size_t extras = film.extra_names().size();
    for (std::size_t i = 0; i < film.pixels().size(); ++i) {
        get_pixel(in, film.pixels()[i]);
        for (ExactSum& s : film.extra_sums().subspan(i * extras, extras)) s.set_units(in.sum());
    }
    if (film.has_splats()) {
        const auto paths = in.number<std::uint64_t>();
        if (paths > std::uint64_t{1} << 62) in.fail("is a damaged film file");
        film.count_light_paths(static_cast<std::int64_t>(paths));
        for (ExactSum& s : film.splat_sums()) s.set_units(in.sum());
    }
    if (!in.rest.empty()) in.fail("is a damaged film file");
    return file;
}

bool is_film_file(const std::string& path) {
    return std::filesystem::path(path).extension() == ".film";
}

}  // namespace gischt
