// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "schema/component.h"

namespace gischt {

// The range in words, without the unit: "at least 0 and below 1"; empty when there is none.
std::string range_text(const ParameterOptions& options);

// "whole number", "3 numbers over time", "one of linear, smooth", "list of tables".
std::string type_text(const Parameter& parameter);

// The default as it would be written in a scene file; "unset", or "required".
std::string default_text(const Component& component, const Parameter& parameter);

}  // namespace gischt
