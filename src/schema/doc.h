// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "schema/component.h"

namespace gischt {

// `root` and every component that its tables lead to, each once, in the order of the tables.
std::vector<const Component*> all_components(const Component& root);

// The manual of one component for a terminal of 100 columns: every key with type, unit, default,
// range, meaning and words.
std::string document(const Component& component);

// The manual of what `address` names: a component ("medium"), a key of one ("medium.g"), a path
// from the root ("fluid.medium.g"), or, when empty, the list of all components. Throws
// Error{Usage} with the nearest word when there is no such thing.
std::string document(const Component& root, std::string_view address);

// The manual of all components below `root` as Markdown, one heading and table each.
std::string markdown(const Component& root);

// A JSON schema (draft 2020-12) that accepts what the tables accept, for editors. Checks across
// keys and the order of key times are not in it.
std::string json_schema(const Component& root);

}  // namespace gischt
