// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/zonal/enclosure.h"

namespace gischt {

// What a zone does to light on a chord of length c, per channel, k being its extinction:
// L_out = L (1 - k l) + q l, and the integral of L over the chord is L l + q m, q being the source
// in W/(m^3 sr); l = (1 - exp(-k c)) / k, m = (c - l) / k. Exact for even zones, and as
// L + q c = L_out + k (L l + q m), what goes in comes out whatever rounding does to l.
struct ChordLength {
    float l = 0, m = 0;
};
ChordLength chord_length(float extinction, float chord);

// What arrives at the elements of an enclosure.
struct ArrivingLight {
    // Of a zone the integral of radiance over volume and directions, W m; of a patch that of
    // radiance times cosine over area and directions, W.
    std::vector<Vec3f> at;
    // W that leave by each cell of the sides; 0 at mirrors.
    std::vector<Vec3f> leaving;
};

// The transport of light through an enclosure along its lines: the operator that the zonal method
// inverts. Each line is followed both ways, so that what an element i gives to j per unit of its
// source is what j gives to i, to the last digit but rounding: exchange factors without a matrix.
// Costs some 20 ns per crossing of a zone.
class ZoneSweep {
  public:
    // The enclosure must outlive it.
    ZoneSweep(const Enclosure& enclosure, Job& job);

    // Light of sources, in W/(m^3 sr) of zones and W/(m^2 sr) of patches, and, where asked for,
    // from beyond the open sides.
    ArrivingLight operator()(std::span<const Vec3f> source, bool with_incoming) const;

    // What ArrivingLight::at would be of radiance 1: 4 pi V of a zone, pi A of a patch, as the
    // lines measure it. Dividing by it is what keeps closed enclosures exact.
    const std::vector<float>& measure() const { return measure_; }
    // Mean radiance of what arrives: over all directions in a zone, by cosine on a patch.
    std::vector<Vec3f> mean_radiance(const ArrivingLight& light) const;
    // Largest relative difference between 4 pi V and what the lines measure.
    double measure_error() const;

    const Enclosure& enclosure() const { return enclosure_; }

  private:
    void sweep_task(int task, std::span<const Vec3f> source, bool with_incoming,
                    ArrivingLight& out) const;

    const Enclosure& enclosure_;
    Job& job_;
    std::vector<float> measure_;
};

}  // namespace gischt
