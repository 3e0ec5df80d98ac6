// SPDX-License-Identifier: Apache-2.0
#include "panel.h"

#include <fmt/format.h>
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>

#include <algorithm>

#include "schema/toml.h"

namespace gischt {
namespace {

std::string label_of(const Parameter& p) {
    return p.options.unit.empty() ? p.key : fmt::format("{} ({})", p.key, p.options.unit);
}

void tip(const Parameter& p, const std::string& path) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 30);
    ImGui::TextUnformatted(p.options.help.c_str());
    ImGui::TextDisabled("%s", path.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool is_number_form(const Parameter& p) {
    return !p.form.list && p.form.count <= 4 &&
           (p.form.type == ParameterForm::Type::Real ||
            p.form.type == ParameterForm::Type::Integer);
}

// The numbers of a value; nothing where it is unset or has keyframes.
std::vector<double> numbers_of(const Value* value) {
    std::vector<double> list;
    if (value && value->is_number()) list.push_back(value->number());
    if (value && value->is_array()) {
        for (const Value& v : value->array()) {
            if (!v.is_number()) return {};
            list.push_back(v.number());
        }
    }
    return list;
}

}  // namespace

void ParameterPanel::change(const std::string& path, const std::string& value) {
    changes_.emplace_back(path, value);
}

bool ParameterPanel::draw(const Component& component, const Value& values,
                          std::vector<std::string>& overrides) {
    changes_.clear();
    table(component, values, "");
    for (const auto& [path, value] : changes_) {
        const std::string start = path + "=";
        std::erase_if(overrides, [&](const std::string& o) { return o.starts_with(start); });
        overrides.push_back(start + value);
    }
    return !changes_.empty();
}

void ParameterPanel::table(const Component& component, const Value& values,
                           const std::string& path) {
    const Component* content = &component;
    if (!component.alternatives.empty()) {
        const Value* type = values.find(component.selector);
        if (!type || !type->is_string()) return;
        const Alternative* one = component.find_alternative(type->string());
        if (!one) return;
        ImGui::TextDisabled("%s: %s", component.selector.c_str(), one->word.c_str());
        content = one->component;
    }
    for (const Parameter& p : content->parameters) {
        const std::string at = join_path(path, p.key);
        const Value* value = values.find(p.key);
        ImGui::PushID(p.key.c_str());
        if (p.form.type != ParameterForm::Type::Table) {
            parameter(p, value, at);
        } else if (value && value->is_array()) {
            for (std::size_t i = 0; i < value->array().size(); ++i) {
                const Value& element = value->array()[i];
                const Value* name = element.find("name");
                const std::string title = fmt::format(
                    "{} {}###{}", p.key,
                    name && name->is_string() && !name->string().empty() ? name->string()
                                                                         : std::to_string(i),
                    i);
                if (ImGui::TreeNode(title.c_str())) {
                    table(*p.component, element, fmt::format("{}.{}", at, i));
                    ImGui::TreePop();
                }
            }
        } else if (value && value->is_table() && ImGui::TreeNode(p.key.c_str())) {
            table(*p.component, *value, at);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

void ParameterPanel::parameter(const Parameter& p, const Value* value, const std::string& path) {
    const std::string label = label_of(p);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
    if (p.form.type == ParameterForm::Type::Choice) {
        choice(p, value, path);
    } else if (p.form.type == ParameterForm::Type::Boolean && value) {
        bool on = value->boolean();
        if (ImGui::Checkbox(label.c_str(), &on)) change(path, on ? "true" : "false");
    } else if (!is_number_form(p) || !numbers(label, p, value, path)) {
        text(label, value, path, p.form.type == ParameterForm::Type::String && !p.form.list);
    }
    tip(p, path);
}

void ParameterPanel::choice(const Parameter& p, const Value* value, const std::string& path) {
    const std::string now = value && value->is_string() ? value->string() : "";
    if (!ImGui::BeginCombo(p.key.c_str(), now.c_str())) return;
    for (const ChoiceInfo& c : p.choices) {
        if (ImGui::Selectable(c.word.c_str(), c.word == now)) change(path, c.word);
        if (!c.help.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", c.help.c_str());
    }
    ImGui::EndCombo();
}

// Numbers to drag or type; false where the value is none that can be shown so.
bool ParameterPanel::numbers(const std::string& label, const Parameter& p, const Value* value,
                             const std::string& path) {
    std::vector<double> now = numbers_of(value);
    if (now.empty()) return false;
    const auto held = numbers_.find(path);
    if (held != numbers_.end()) now = held->second;
    const bool is_whole = p.form.type == ParameterForm::Type::Integer;
    double size = 0;
    for (const double x : now) size = std::max(size, std::abs(x));
    const auto speed = static_cast<float>(is_whole ? 0.2 : std::max(1e-3, 0.01 * size));
    const bool changed = ImGui::DragScalarN(
        label.c_str(), ImGuiDataType_Double, now.data(), static_cast<int>(now.size()), speed,
        nullptr, nullptr, is_whole ? "%.0f" : "%.6g", ImGuiSliderFlags_NoRoundToFormat);
    if (changed) {
        for (double& x : now) {  // what the parser would refuse is not offered
            x = std::clamp(is_whole ? std::round(x) : x, p.options.min, p.options.max);
        }
        numbers_[path] = now;
    }
    if (ImGui::IsItemDeactivatedAfterEdit() && numbers_.contains(path)) {
        std::string list;
        for (const double x : numbers_[path]) {
            list += (list.empty() ? "" : ", ") +
                    (is_whole ? fmt::format("{:.0f}", x) : fmt::format("{}", x));
        }
        change(path, value->is_array() ? "[" + list + "]" : list);
    }
    if (!ImGui::IsItemActive()) numbers_.erase(path);
    return true;
}

// Anything else as the text of the scene file.
void ParameterPanel::text(const std::string& label, const Value* value, const std::string& path,
                          bool is_string) {
    std::string now;
    if (value) now = is_string && value->is_string() ? value->string() : to_inline_toml(*value);
    const auto held = edited_.find(path);
    if (held != edited_.end()) now = held->second;
    if (ImGui::InputTextWithHint(label.c_str(), "unset", &now)) edited_[path] = now;
    if (ImGui::IsItemDeactivatedAfterEdit() && edited_.contains(path)) change(path, edited_[path]);
    if (!ImGui::IsItemActive()) edited_.erase(path);
}

}  // namespace gischt
