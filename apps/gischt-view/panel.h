// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "schema/component.h"

namespace gischt {

// Every parameter of a scene as a widget with its unit and help, made from the tables that the
// parser and the manual are made from. A change is an override KEY=VALUE, as of `--set`.
class ParameterPanel {
  public:
    // Draws the widgets of a scene's values (all keys, see write_component). True when the user has
    // changed something; then `overrides` holds it.
    bool draw(const Component& component, const Value& values, std::vector<std::string>& overrides);

  private:
    void table(const Component& component, const Value& values, const std::string& path);
    void parameter(const Parameter& parameter, const Value* value, const std::string& path);
    void choice(const Parameter& parameter, const Value* value, const std::string& path);
    void text(const std::string& label, const Value* value, const std::string& path,
              bool is_string);
    bool numbers(const std::string& label, const Parameter& parameter, const Value* value,
                 const std::string& path);
    void change(const std::string& path, const std::string& value);

    std::map<std::string, std::string> edited_;                 // text being typed, by path
    std::map<std::string, std::vector<double>> numbers_;        // the same of numbers
    std::vector<std::pair<std::string, std::string>> changes_;  // of this call
};

}  // namespace gischt
