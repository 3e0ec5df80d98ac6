// SPDX-License-Identifier: Apache-2.0
#include "optics/moving_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/flow.h"

namespace gischt {
namespace {

// The fields that a medium is made of.
std::vector<std::string> fields_of(const MediumParams& p) {
    std::vector<std::string> names{p.density_field};
    if (p.emission != EmissionKind::None) {
        const bool flame = p.emission == EmissionKind::Flame;
        names.push_back(p.emission_field.value_or(flame ? "flame" : "temperature"));
    }
    if (p.color_field) {
        for (const char* axis : {"", "_r", "_g", "_b"}) names.push_back(*p.color_field + axis);
    }
    return names;
}

Frame frame_after(const Frame& frame, const std::vector<std::string>& names, const Flow& flow,
                  double seconds, Job& job) {
    Frame out;
    for (const std::string& name : names) {
        if (const Field* field = frame.find(name)) {
            out.fields.emplace(name, carried(*field, flow, seconds, job));
        }
    }
    return out;
}

}  // namespace

std::vector<std::shared_ptr<const Medium>> media_while_exposed(
    const Frame& frame, const std::shared_ptr<const Medium>& middle, const MediumParams& params,
    const Exposure& exposure, Job& job) {
    if (!(exposure.shutter > 0) || exposure.most_parts < 3 || !middle->bricks()) return {middle};
    const Field* velocity = frame.find("velocity");
    const Field* density = frame.find(params.density_field);
    if (!density || density->map().size() == 0) return {middle};
    if (!velocity || !velocity->is_vector()) {
        job.warn("a fluid has no field 'velocity': it stands still while the film is exposed");
        return {middle};
    }
    const PhaseTimer timer(job, "motion blur");
    const Flow flow(*velocity, *density, 0.5 * exposure.shutter, job);
    const double voxels = flow.fastest_content() * exposure.shutter / middle->cell_size();
    if (!(voxels > 0.1)) return {middle};
    int parts = 3;
    while (parts < 2 * voxels && 3 * parts <= exposure.most_parts) parts *= 3;
    if (parts < 2 * voxels) {
        job.info(
            fmt::format("a fluid moves by up to {:.1f} voxels while the film is exposed, and "
                        "is taken at {} moments",
                        voxels, parts));
    }
    std::vector<std::shared_ptr<const Medium>> media;
    const std::vector<std::string> names = fields_of(params);
    for (int i = 0; i < parts; ++i) {
        if (2 * i + 1 == parts) {
            media.push_back(middle);
            continue;
        }
        const double seconds = ((i + 0.5) / parts - 0.5) * exposure.shutter;
        media.push_back(std::make_shared<const Medium>(
            frame_after(frame, names, flow, seconds, job), params, exposure.time, job));
    }
    return media;
}

}  // namespace gischt
