// SPDX-License-Identifier: Apache-2.0
#include "scene/preset.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "schema/toml.h"

namespace gischt {
namespace {

struct Preset {
    std::string name;
    const char* medium;  // TOML: what is set in the medium; the extinction stays, since it belongs
                         // to the size of things
};

const std::vector<Preset>& presets() {
    static const std::vector<Preset> list{
        {"smoke", "albedo = [0.80, 0.79, 0.78]\ng = 0.35\nmultiple_scattering = { octaves = 4 }"},
        {"fire",
         "albedo = [0.45, 0.42, 0.40]\ng = 0.3\nemission = 'flame'\nmultiple_scattering = { "
         "octaves = 3 }"},
        {"cloud", "albedo = 0.9999\ng = 0.75\nmultiple_scattering = { octaves = 8 }"},
        {"steam", "albedo = 0.98\ng = 0.6\nmultiple_scattering = { octaves = 5 }"},
        {"fog", "albedo = 0.99\ng = 0.7\nmultiple_scattering = { octaves = 4 }"},
    };
    return list;
}

void set_medium(Value& fluid, const Value& look, const Location& from) {
    Value* medium = fluid.find("medium");
    if (!medium) medium = &fluid.set("medium", Value());
    if (!medium->is_table()) return;  // the table of the scene will say what is wrong with it
    std::erase_if(medium->members(),
                  [](const Value::Member& m) { return m.key == "emission_field"; });
    for (const Value::Member& m : look.members()) medium->set(m.key, m.value, from);
}

}  // namespace

const std::vector<std::string>& preset_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Preset& p : presets()) list.push_back(p.name);
        return list;
    }();
    return names;
}

void apply_preset(Value& scene, std::string_view name) {
    const auto found = std::ranges::find(presets(), name, &Preset::name);
    if (found == presets().end()) {
        throw Error(ErrorKind::Usage, "--preset", fmt::format("no preset '{}'", name),
                    hint_for(name, preset_names()));
    }
    const std::string source = "--preset " + found->name;
    const Value look = parse_toml(found->medium, source);
    Value* fluid = scene.find("fluid");
    if (fluid && fluid->is_table()) set_medium(*fluid, look, {source});
    if (fluid && fluid->is_array()) {
        for (Value& f : fluid->array()) {
            if (f.is_table()) set_medium(f, look, {source});
        }
    }
}

}  // namespace gischt
