// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "base/hash.h"
#include "base/parallel.h"
#include "fluid/particles/particle_state.h"
#include "fluid/smoke_source.h"
#include "input.h"
#include "readers.h"
#include "scene/load.h"
#include "schema/toml.h"
#include "studio/estimate.h"

namespace gischt {

// The hash of a state file: over its first line, then over the rest, the last 8 bytes being it.
static std::string with_word_hash(std::string bytes) {
    const std::size_t line = bytes.find('\n');
    if (line == bytes.npos || bytes.size() < line + 9) return bytes;
    WordHash hash;
    hash.add(bytes.data(), line + 1);
    hash.add(bytes.data() + line + 1, bytes.size() - line - 9);
    const std::uint64_t value = hash.value();
    std::memcpy(bytes.data() + bytes.size() - 8, &value, 8);
    return bytes;
}

void fuzz_state(std::string_view bytes) {
    static const ThreadLimit one(1);
    static SmokeSource source = [] {
        SmokeParams params;
        params.domain.resolution = 8;
        return SmokeSource(params, {});
    }();
    for (const std::string& whole : {std::string(bytes), with_word_hash(std::string(bytes))}) {
        const InputFile file(whole, ".state");
        int frame = 0;
        expect_read_or_refused([&] { source.load_state(file.path()); });
        expect_read_or_refused([&] { load_particle_state(file.path(), frame); });
    }
}

void fuzz_scene(std::string_view bytes) {
    static const ThreadLimit one(1);
    expect_read_or_refused([&] {
        Value tree = parse_toml(std::string(bytes), "fuzz.toml");
        const LoadedScene scene = load_scene_tree("fuzz", std::move(tree), "", {});
        estimate_fluids(scene.scene);
    });
}

}  // namespace gischt
