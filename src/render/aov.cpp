// SPDX-License-Identifier: Apache-2.0
#include "render/aov.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/error.h"
#include "render/method.h"

namespace gischt {
namespace {

constexpr std::array<AovInfo, 9> infos{{
    {Aov::Direct, "direct", "RGB"},
    {Aov::Indirect, "indirect", "RGB"},
    {Aov::Emission, "emission", "RGB"},
    {Aov::Albedo, "albedo", "RGB"},
    {Aov::Normal, "normal", "XYZ"},
    {Aov::Motion, "motion", "XY"},
    {Aov::Transmittance, "transmittance", "RGB"},
    {Aov::Variance, "variance", "Y"},
    {Aov::Samples, "samples", "Y"},
}};

bool is_of_film(Aov aov) {
    return aov == Aov::Variance || aov == Aov::Samples;
}

bool is_supported(Aov aov, const AovSupport& support) {
    return is_of_film(aov) ||
           std::find(support.aovs.begin(), support.aovs.end(), aov) != support.aovs.end();
}

// Appends the channels of a layer and tells the place of the first.
int append(AovLayout& layout, std::string_view layer, std::string_view letters) {
    const auto place = static_cast<int>(layout.channels.size());
    for (const char c : letters) layout.channels.push_back(fmt::format("{}.{}", layer, c));
    return place;
}

void add_aov(AovLayout& layout, const AovInfo& info) {
    if (info.aov == Aov::Variance) {
        layout.variance = true;
    } else if (info.aov == Aov::Samples) {
        layout.samples = true;
    } else {
        int* const places[] = {&layout.direct,       &layout.indirect, &layout.emission,
                               &layout.albedo,       &layout.normal,   &layout.motion,
                               &layout.transmittance};
        *places[static_cast<std::size_t>(info.aov)] = append(layout, info.name, info.channels);
    }
}

const AovInfo& find_aov(const std::string& name, const AovSupport& support) {
    std::vector<std::string> names{"all"};
    for (const AovInfo& info : infos) {
        if (is_supported(info.aov, support)) names.emplace_back(info.name);
        if (info.name != name) continue;
        if (is_supported(info.aov, support)) return info;
        throw Error(ErrorKind::Usage, "film.aovs",
                    fmt::format("method '{}' has no '{}'", support.method, name),
                    "take another method, or \"all\" for what it has");
    }
    throw Error(ErrorKind::Usage, "film.aovs", fmt::format("there is no '{}'", name),
                hint_for(name, names));
}

}  // namespace

std::span<const AovInfo> aov_table() {
    return infos;
}

AovLayout aov_layout(const View& view, const RenderSettings& settings, const AovSupport& support) {
    // In the order of the table, whatever the order of the names.
    std::array<bool, infos.size()> wanted{};
    for (const std::string& name : settings.aovs) {
        for (std::size_t i = 0; name == "all" && i < infos.size(); ++i) {
            wanted[i] = wanted[i] || is_supported(infos[i].aov, support);
        }
        if (name != "all") wanted[static_cast<std::size_t>(find_aov(name, support).aov)] = true;
    }
    AovLayout layout;
    for (std::size_t i = 0; i < infos.size(); ++i) {
        if (wanted[i]) add_aov(layout, infos[i]);
    }

    layout.light_group.assign(view.lights.size(), -1);
    if (!support.light_groups) return layout;
    std::map<std::string, int> places;
    for (const LightPtr& light : view.lights) {
        if (!light->group.empty()) places[light->group] = -1;
    }
    for (auto& [group, place] : places) place = append(layout, "light_" + group, "RGB");
    for (std::size_t l = 0; l < view.lights.size(); ++l) {
        const auto found = places.find(view.lights[l]->group);
        if (found != places.end()) layout.light_group[l] = found->second;
    }
    return layout;
}

}  // namespace gischt
