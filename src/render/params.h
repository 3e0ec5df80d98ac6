// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/bdpt/bdpt_params.h"
#include "render/billboards/billboards_params.h"
#include "render/diffusion/diffusion_params.h"
#include "render/field/field_params.h"
#include "render/march/gpu_march_params.h"
#include "render/march/march_params.h"
#include "render/mlt/mlt_params.h"
#include "render/path/path_params.h"
#include "render/photon/photon_params.h"
#include "render/points/points_params.h"
#include "render/slices/slices_params.h"
#include "render/zonal/zonal_params.h"
#include "schema/table.h"

namespace gischt {

// The parameters of all render methods, each in a table of the method's name.
struct RenderParams {
    MarchParams march;
    FieldParams field;
    PathParams path;
    PhotonParams photon;
    BdptParams bdpt;
    MltParams mlt;
    PointsParams points;
    BillboardsParams billboards;
    SlicesParams slices;
    GpuMarchParams gpu_march;
    ZonalParams zonal;
    DiffusionParams diffusion;
};

const Table<RenderParams>& render_params_table();

}  // namespace gischt
