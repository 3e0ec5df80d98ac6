// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gischt {

// Share of the light of one direction that a single scattering on GGX microfacets reflects, over
// all directions: E(cosine). The rest has met several facets, and a model of single scattering
// loses it (Kulla & Conty 2017; Turquin 2019). Tabulated once, within 1e-3.
class EnergyTable {
  public:
    // Facets that reflect everything.
    explicit EnergyTable(double alpha) : EnergyTable(alpha, 0) {}
    // Facets that reflect by Fresnel's formulae of a dielectric of relative index `eta`; 0: all.
    // alpha may be 0.
    EnergyTable(double alpha, double eta);

    double at(double cosine) const;
    // Mean over the hemisphere with weight cosine.
    double mean() const { return mean_; }

  private:
    std::vector<double> values_;  // at cosine (i / n)^2
    double mean_ = 0;
};

// The same for what a rough dielectric reflects or lets pass, by the relative index of refraction.
class DielectricEnergyTable {
  public:
    explicit DielectricEnergyTable(double alpha);

    // `eta` counts within [1/4, 4].
    double at(double cosine, double eta) const;

  private:
    std::vector<double> values_;  // by cosine (i / n)^2, then by log eta
};

}  // namespace gischt
