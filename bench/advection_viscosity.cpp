// SPDX-License-Identifier: Apache-2.0
// The viscosity that advection schemes have by themselves: a Taylor-Green vortex without viscosity,
// u = sin x cos y, v = -cos x sin y on [0, 2 pi]^2, periodic, whose energy would stay for ever.
// What it loses is fitted by exp(-4 nu t). Prints a Markdown table over the schemes and
// interpolations that the parameters of smoke know, resolutions and CFL numbers: nu / (U h), U
// being the largest speed of the vortex, and the order with which nu falls from the coarser
// resolution before.
//
//   advection_viscosity [--quick]
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "base/units.h"
#include "fluid/smoke.h"

namespace {

using namespace gischt;

// The words of a parameter of smoke; none where it does not exist.
std::vector<std::string> words_of(const char* key) {
    std::vector<std::string> words;
    const Parameter* parameter = smoke_table().find(key);
    if (!parameter) return words;
    for (const ChoiceInfo& choice : parameter->choices) words.push_back(choice.word);
    return words;
}

struct Scheme {
    std::string accuracy, advection, interpolation;  // accuracy is empty where there is no choice
};

// With high accuracy the solver chooses the interpolation itself.
std::vector<Scheme> all_schemes() {
    std::vector<std::string> accuracies = words_of("accuracy");
    if (accuracies.empty()) accuracies = {""};
    std::vector<Scheme> schemes;
    for (std::size_t a = 0; a < accuracies.size(); ++a) {
        for (const std::string& advection : words_of("velocity_advection")) {
            for (const std::string& interpolation : words_of("interpolation")) {
                const bool is_first = interpolation == words_of("interpolation").front() &&
                                      advection == words_of("velocity_advection").front();
                if (a == 0 || is_first)
                    schemes.push_back({accuracies[a], advection, interpolation});
            }
        }
    }
    return schemes;
}

SmokeParams params_of(const Scheme& scheme, int resolution) {
    SmokeParams params;
    params.domain.resolution = resolution;
    params.domain.max = {2 * pi, 2 * pi, 0};
    params.domain.set_all_sides(SideKind::Periodic);
    params.pressure_tolerance = 1e-6;
    Value chosen;
    if (!scheme.accuracy.empty()) chosen.set("accuracy", Value(scheme.accuracy));
    chosen.set("velocity_advection", Value(scheme.advection));
    chosen.set("interpolation", Value(scheme.interpolation));
    read_into(params, chosen, smoke_table(), "smoke");
    return params;
}

// nu in m^2/s: the slope of the logarithm of the energy over a time of 2 s, in which the fluid goes
// a third of the way around an eddy, by least squares.
double measure_viscosity(const Scheme& scheme, int resolution, double cfl) {
    FluidWorld world;
    world.gravity = {};
    SmokeSolver solver(params_of(scheme, resolution), world);
    Job job;
    solver.fill({.velocity =
                     [](const Vec3d& p) {
                         return Vec3d(std::sin(p.x) * std::cos(p.y), -std::cos(p.x) * std::sin(p.y),
                                      0);
                     },
                 .density = nullptr,
                 .temperature = nullptr},
                job);
    constexpr double time = 2;
    const int steps = std::max(4, static_cast<int>(std::lround(time / (cfl * solver.domain().h))));
    double t = 0, y = 0, tt = 0, ty = 0;
    for (int s = 0; s < steps; ++s) {
        const StepStatistics step = solver.step(time / steps, job);
        const double now = solver.state().time, log_energy = std::log(step.kinetic_energy);
        t += now;
        y += log_energy;
        tt += now * now;
        ty += now * log_energy;
    }
    const double slope = (steps * ty - t * y) / (steps * tt - t * t);
    return -slope / 4;
}

}  // namespace

int main(int argc, char** argv) {
    const bool is_quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const std::vector<int> resolutions =
        is_quick ? std::vector<int>{32, 64} : std::vector<int>{32, 64, 128};
    fmt::print(
        "| scheme | interpolation | cells | CFL 0.5 | CFL 1 | CFL 2 | CFL 4 | order in h at "
        "CFL 1 |\n|---|---|---|---|---|---|---|---|\n");
    for (const Scheme& scheme : all_schemes()) {
        double coarser = 0;
        for (const int n : resolutions) {
            const double h = 2 * pi / n;
            std::string line;
            double at_one = 0;
            for (const double cfl : {0.5, 1.0, 2.0, 4.0}) {
                const double nu = measure_viscosity(scheme, n, cfl);
                if (cfl == 1) at_one = nu;
                line += fmt::format(" {:+.2e} |", nu / h);
            }
            // No order where the viscosity has changed its sign.
            const bool has_order = coarser * at_one > 0;
            const bool is_high =
                !scheme.accuracy.empty() && scheme.accuracy != words_of("accuracy").front();
            fmt::print("| {} | {} | {}^2 |{} {} |\n",
                       is_high ? "accuracy = " + scheme.accuracy : scheme.advection,
                       is_high ? "its own" : scheme.interpolation, n, line,
                       has_order ? fmt::format("{:.1f}", std::log2(coarser / at_one)) : "-");
            coarser = at_one;
        }
    }
    return 0;
}
