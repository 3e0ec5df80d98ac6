// SPDX-License-Identifier: Apache-2.0
#include "render/method.h"

#include <vector>

#include "base/error.h"
#include "render/bdpt/bdpt.h"
#include "render/billboards/billboards.h"
#include "render/diffusion/diffusion.h"
#include "render/field/field.h"
#include "render/march/gpu_march.h"
#include "render/march/march.h"
#include "render/mlt/mlt.h"
#include "render/params.h"
#include "render/path/path.h"
#include "render/photon/photon.h"
#include "render/points/points.h"
#include "render/slices/slices.h"
#include "render/zonal/zonal.h"

namespace gischt {
namespace {

constexpr MethodInfo methods[] = {
    {"field", field_simulates, field_leaves_out, field_cost,
     [](const RenderParams& p) { return make_field_method(p.field); }},
    {"points", points_simulates, points_leaves_out, points_cost,
     [](const RenderParams& p) { return make_points_method(p.points); }},
    {"billboards", billboards_simulates, billboards_leaves_out, billboards_cost,
     [](const RenderParams& p) { return make_billboards_method(p.billboards); }},
    {"slices", slices_simulates, slices_leaves_out, slices_cost,
     [](const RenderParams& p) { return make_slices_method(p.slices); }},
    {"gpu_march", gpu_march_simulates, gpu_march_leaves_out, gpu_march_cost,
     [](const RenderParams& p) { return make_gpu_march_method(p.gpu_march); }},
    {"march", march_simulates, march_leaves_out, march_cost,
     [](const RenderParams& p) { return make_march_method(p.march); }},
    {"photon", photon_simulates, photon_leaves_out, photon_cost,
     [](const RenderParams& p) { return make_photon_method(p.photon); }},
    {"diffusion", diffusion_simulates, diffusion_leaves_out, diffusion_cost,
     [](const RenderParams& p) { return make_diffusion_method(p.diffusion); }},
    {"zonal", zonal_simulates, zonal_leaves_out, zonal_cost,
     [](const RenderParams& p) { return make_zonal_method(p.zonal); }},
    {"path", path_simulates, path_leaves_out, path_cost,
     [](const RenderParams& p) { return make_path_method(p.path); }},
    {"bdpt", bdpt_simulates, bdpt_leaves_out, bdpt_cost,
     [](const RenderParams& p) { return make_bdpt_method(p.bdpt); }},
    {"mlt", mlt_simulates, mlt_leaves_out, mlt_cost,
     [](const RenderParams& p) { return make_mlt_method(p.mlt); }},
};

}  // namespace

const Table<RenderParams>& render_params_table() {
    static const Table<RenderParams> table =
        Table<RenderParams>("render", "The parameters of the render methods")
            .sub("march", &RenderParams::march, march_table(), {.help = "Of the method 'march'"})
            .sub("field", &RenderParams::field, field_params_table(),
                 {.help = "Of the method 'field'"})
            .sub("path", &RenderParams::path, path_table(), {.help = "Of the method 'path'"})
            .sub("photon", &RenderParams::photon, photon_table(),
                 {.help = "Of the method 'photon'"})
            .sub("bdpt", &RenderParams::bdpt, bdpt_table(), {.help = "Of the method 'bdpt'"})
            .sub("mlt", &RenderParams::mlt, mlt_table(), {.help = "Of the method 'mlt'"})
            .sub("points", &RenderParams::points, points_table(),
                 {.help = "Of the method 'points'"})
            .sub("billboards", &RenderParams::billboards, billboards_table(),
                 {.help = "Of the method 'billboards'"})
            .sub("slices", &RenderParams::slices, slices_table(),
                 {.help = "Of the method 'slices'"})
            .sub("gpu_march", &RenderParams::gpu_march, gpu_march_table(),
                 {.help = "Of the method 'gpu_march'"})
            .sub("zonal", &RenderParams::zonal, zonal_table(), {.help = "Of the method 'zonal'"})
            .sub("diffusion", &RenderParams::diffusion, diffusion_table(),
                 {.help = "Of the method 'diffusion'"});
    return table;
}

std::span<const MethodInfo> render_methods() {
    return methods;
}

const MethodInfo& find_method(std::string_view name) {
    std::vector<std::string> names;
    for (const MethodInfo& m : methods) {
        if (m.name == name) return m;
        names.emplace_back(m.name);
    }
    throw Error(ErrorKind::Usage, "render", "there is no method '" + std::string(name) + "'",
                hint_for(name, names));
}

std::unique_ptr<RenderMethod> make_method(std::string_view name, const RenderParams& params) {
    return find_method(name).make(params);
}

}  // namespace gischt
