// SPDX-License-Identifier: Apache-2.0
#include "render/realtime/depth_sort.h"

#include <algorithm>

namespace gischt {
namespace {

constexpr int group = 32;  // invocations
constexpr int passes = 3;  // of eight bits

// Points per invocation. A processor has few of them to keep busy, and each costs it a table.
int run_length(const GlDevice& device) {
    return device.limits().is_software ? 1024 : 128;
}

const char* const keys_source = R"(
layout(local_size_x = 32) in;
layout(std430, binding = 0) readonly buffer Places { vec4 place[]; };
layout(std430, binding = 1) writeonly buffer Keys { uint key[]; };
layout(std430, binding = 2) writeonly buffer Indices { uint index[]; };
uniform int count, run;
void main() {
    int first = int(gl_GlobalInvocationID.x) * run;
    for (int i = first; i < min(first + run, count); ++i) {
        float z = dot(place[i].xyz - eye, forward);
        // Positive floats are ordered as their bits; there is no sign, and 16 bits of the mantissa
        // are left.
        key[i] = z > 0 ? ~(floatBitsToUint(z) << 1) >> 8 : 0xffffffffu;
        index[i] = uint(i);
    }
}
)";

// table[digit * runs + r]: how often run r has the digit.
const char* const count_source = R"(
layout(local_size_x = 32) in;
layout(std430, binding = 1) readonly buffer Keys { uint key[]; };
layout(std430, binding = 5) buffer Table { uint table[]; };
uniform int count, run, runs, shift;
void main() {
    int r = int(gl_GlobalInvocationID.x);
    if (r >= runs) return;
    for (int d = 0; d < 256; ++d) table[d * runs + r] = 0u;
    for (int i = r * run; i < min((r + 1) * run, count); ++i) {
        table[int((key[i] >> shift) & 255u) * runs + r] += 1u;
    }
}
)";

// Turns counts into places: the sum of all that come before. One invocation per digit sums its
// runs; the last entries of the table hold the digits' totals.
const char* const sum_source = R"(
layout(local_size_x = 256) in;
layout(std430, binding = 5) coherent buffer Table { uint table[]; };
uniform int runs;
void main() {
    int d = int(gl_LocalInvocationID.x);
    uint total = 0u;
    for (int r = 0; r < runs; ++r) {
        uint c = table[d * runs + r];
        table[d * runs + r] = total;
        total += c;
    }
    table[256 * runs + d] = total;
}
)";

const char* const scatter_source = R"(
layout(local_size_x = 32) in;
layout(std430, binding = 1) readonly buffer Keys { uint key[]; };
layout(std430, binding = 2) readonly buffer Indices { uint index[]; };
layout(std430, binding = 3) writeonly buffer KeysOut { uint key_out[]; };
layout(std430, binding = 4) writeonly buffer IndicesOut { uint index_out[]; };
layout(std430, binding = 5) buffer Table { uint table[]; };
uniform int count, run, runs, shift;
void main() {
    int r = int(gl_GlobalInvocationID.x);
    if (r >= runs) return;
    uint base = 0u;
    for (int d = 0; d < 256; ++d) {
        table[d * runs + r] += base;
        base += table[256 * runs + d];
    }
    for (int i = r * run; i < min((r + 1) * run, count); ++i) {
        int slot = int((key[i] >> shift) & 255u) * runs + r;
        uint at = table[slot];
        table[slot] = at + 1u;
        key_out[at] = key[i];
        index_out[at] = index[i];
    }
}
)";

GlProgram compute(GlDevice& device, const char* name, const std::string& source) {
    return GlProgram(device, name, {{GlStageKind::Compute, source}});
}

}  // namespace

DepthSort::DepthSort(GlDevice& device)
    : device_(device),
      keys_(compute(device, "sort_keys", std::string(camera_glsl) + keys_source)),
      count_(compute(device, "sort_count", count_source)),
      sum_(compute(device, "sort_sum", sum_source)),
      scatter_(compute(device, "sort_scatter", scatter_source)) {}

void DepthSort::resize(int count) {
    if (count <= capacity_) return;
    capacity_ = count;
    const auto n = static_cast<std::size_t>(count);
    for (int i = 0; i < 2; ++i) {
        key_[i] = GlBuffer(device_, 4 * n);
        index_[i] = GlBuffer(device_, 4 * n);
    }
    const auto run = static_cast<std::size_t>(run_length(device_));
    const std::size_t runs = (n + run - 1) / run;
    table_ = GlBuffer(device_, 4 * 256 * (runs + 1));
}

void DepthSort::sort(const GlBuffer& places, int count, const GlCamera& camera) {
    resize(std::max(count, 1));
    if (count == 0) return;
    const int run = run_length(device_), runs = (count + run - 1) / run;
    const Vec3i groups{(runs + group - 1) / group, 1, 1};
    device_.bind_storage(0, places.id());
    device_.bind_storage(1, key_[0].id());
    device_.bind_storage(2, index_[0].id());
    device_.bind_storage(5, table_.id());
    keys_.use();
    camera.set(keys_);
    keys_.set("count", count);
    keys_.set("run", run);
    device_.dispatch(groups);
    device_.barrier();
    for (const GlProgram* p : {&count_, &scatter_}) {
        p->set("count", count);
        p->set("run", run);
        p->set("runs", runs);
    }
    sum_.set("runs", runs);
    for (int pass = 0; pass < passes; ++pass) {
        const int from = pass % 2, to = 1 - from;
        device_.bind_storage(1, key_[from].id());
        device_.bind_storage(2, index_[from].id());
        device_.bind_storage(3, key_[to].id());
        device_.bind_storage(4, index_[to].id());
        count_.set("shift", 8 * pass);
        count_.use();
        device_.dispatch(groups);
        device_.barrier();
        sum_.use();
        device_.dispatch({1, 1, 1});
        device_.barrier();
        scatter_.set("shift", 8 * pass);
        scatter_.use();
        device_.dispatch(groups);
        device_.barrier();
    }
}

}  // namespace gischt
