// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "schema/component.h"
#include "schema/value.h"

namespace gischt {

// How the words of an override's path find their place in a scene.
struct Addressing {
    // A root such as "fluid" that may be left out, and the keys that its members may have.
    struct Implied {
        std::string root;
        std::vector<std::string> keys;
    };
    std::vector<std::string> roots;  // the keys at the top of a scene
    std::vector<std::string> lists;  // those of them that are lists of tables
    std::vector<Implied> implied;
};

// The addressing of a scene whose top level is `scene`.
Addressing addressing_of(const Component& scene, const std::vector<std::string>& implied_roots);

// Writes VALUE of "a.b.c=VALUE" into a scene's tree, before tables are read from it, so that the
// same checks hold as for the file. Missing tables are made.
//   - A member of a list of tables is addressed by its `name` or its index (from 0), and needs
//     neither where it is the only one: light.key.radiance, light.0.radiance, light.radiance.
//   - A path that starts with no root belongs to the only member of an implied root, or to the
//     member of that name: domain.resolution, lava.domain.resolution. So does one that starts with
//     a list that the scene does not have: medium.g means the fluid's where there is no [[medium]].
//   - VALUE is TOML; what is not TOML is a string, so that words and paths need no quotes.
// Throws Error{Usage, "--set a.b.c=VALUE"}: no '=', no such root or member, several members, an
// index out of range, broken TOML in brackets or quotes.
void apply_override(Value& scene, std::string_view assignment, const Addressing& addressing);

}  // namespace gischt
