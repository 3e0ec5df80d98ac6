// SPDX-License-Identifier: Apache-2.0
#include "scene/load.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"
#include "base/hash.h"
#include "io/image_file.h"
#include "scene/builtin.h"
#include "scene/preset.h"
#include "schema/override.h"
#include "schema/toml.h"

namespace gischt {
namespace fs = std::filesystem;

// Lets the relative paths of a scene file count from the folder that it lies in.
static void resolve_paths(Value& value, const fs::path& folder) {
    if (value.is_array()) {
        for (Value& element : value.array()) resolve_paths(element, folder);
    } else if (value.is_table()) {
        for (Value::Member& m : value.members()) {
            const bool is_path =
                m.key == "file" && m.value.is_string() && !m.value.string().empty();
            if (is_path && fs::path(m.value.string()).is_relative()) {
                const Location at = m.value.at;
                m.value = Value((folder / m.value.string()).lexically_normal().string());
                m.value.at = at;
            } else {
                resolve_paths(m.value, folder);
            }
        }
    }
}

static Value read_tree(const std::string& file_or_name, std::string& name) {
    std::error_code ignored;
    if (!fs::exists(file_or_name, ignored)) {
        if (const BuiltinScene* builtin = find_builtin(file_or_name)) {
            name = builtin->name;
            return parse_toml(builtin->text, builtin->name + ".toml");
        }
        std::vector<std::string> names;
        for (const BuiltinScene& b : builtin_scenes()) names.push_back(b.name);
        throw Error(ErrorKind::Usage, file_or_name, "no such scene file or built-in scene",
                    hint_for(file_or_name, names));
    }
    name = fs::path(file_or_name).stem().string();
    Value tree = read_toml(file_or_name);
    resolve_paths(tree, fs::path(file_or_name).parent_path());
    return tree;
}

// `fluid.file = x` makes a fluid of any type one that comes from files: what moved it before is
// dropped.
static void turn_into_files(Value& fluid) {
    const Value* file = fluid.find("file");
    const Value* type = fluid.find("type");
    if (!file || (type && type->is_string() && type->string() == "file")) return;
    static const std::vector<std::string> kept{"name",  "medium", "translate",   "rotate_degrees",
                                               "scale", "file",   "blur_moments"};
    std::erase_if(fluid.members(), [](const Value::Member& m) {
        return std::ranges::find(kept, m.key) == kept.end();
    });
    fluid.set("type", Value("file"), file->at);
}

static void apply_overrides(Value& tree, const std::vector<std::string>& overrides) {
    const Addressing addressing = addressing_of(scene_table(), {"fluid"});
    for (const std::string& assignment : overrides) {
        apply_override(tree, assignment, addressing);
        Value* fluid = tree.find("fluid");
        if (!fluid || assignment.find("file") == std::string::npos) continue;
        if (fluid->is_table()) turn_into_files(*fluid);
        if (fluid->is_array()) {
            for (Value& f : fluid->array()) turn_into_files(f);
        }
    }
}

// Takes away what a fluid or solid does to light, as far as the simulation does not know it.
static void drop_looks(Value& element, bool is_solid) {
    const auto is_look = [&](const Value::Member& m) {
        return m.key == "medium" ||
               (is_solid && m.key != "interior" && material_table().find(m.key));
    };
    const Value* material = element.find("material");
    const bool is_no_obstacle =
        is_solid && material && material->is_string() && material->string() == "none";
    std::erase_if(element.members(), is_look);
    if (is_no_obstacle) element.set("material", Value("none"));
}

// The parts of a scene that its simulation depends on.
static std::string motion_text(const Value& whole) {
    std::string text;
    for (const char* key : {"up", "fps", "seed", "gravity", "fluid", "solid"}) {
        const Value* part = whole.find(key);
        if (!part) continue;
        Value copy = *part;
        if (copy.is_array()) {
            for (Value& element : copy.array()) {
                if (element.is_table()) drop_looks(element, std::string_view(key) == "solid");
            }
        }
        text += std::string(key) + to_inline_toml(copy);
    }
    return text;
}

// All that a sample of a pixel of one frame depends on.
static std::string picture_text(Value whole) {
    auto drop = [](Value& table, const char* key) {
        std::erase_if(table.members(), [&](const Value::Member& m) { return m.key == key; });
    };
    for (const char* key : {"description", "frames"}) drop(whole, key);
    if (Value* film = whole.find("film")) {
        for (const char* key : {"exposure", "tone"}) drop(*film, key);
    }
    if (Value* render = whole.find("render")) drop(*render, "spp");
    return to_inline_toml(whole);
}

// The picture of the billboards, which the method itself cannot read.
static void read_sprites(RenderSection& render) {
    BillboardsParams& b = render.methods.billboards;
    if (render.method != "billboards" || b.file.empty()) return;
    b.picture = std::make_shared<const Image>(read_image(b.file));
}

LoadedScene load_scene_tree(const std::string& name, Value tree, const std::string& preset,
                            const std::vector<std::string>& overrides) {
    if (!preset.empty()) apply_preset(tree, preset);
    apply_overrides(tree, overrides);
    LoadedScene loaded;
    loaded.name = name;
    loaded.scene = read(tree, scene_table(), "");
    read_sprites(loaded.scene.render);
    const Value whole = to_value(loaded.scene, scene_table());
    loaded.hash = hex(hash_bytes(to_inline_toml(whole)));
    loaded.picture_hash = hex(hash_bytes(picture_text(whole)));
    loaded.motion_hash = hex(hash_bytes(motion_text(whole)));
    resolve_paths(tree, fs::current_path());
    loaded.toml = to_toml(tree);
    return loaded;
}

LoadedScene load_scene(const std::string& file_or_name, const std::string& preset,
                       const std::vector<std::string>& overrides) {
    std::string name;
    Value tree = read_tree(file_or_name, name);
    return load_scene_tree(name, std::move(tree), preset, overrides);
}

}  // namespace gischt
