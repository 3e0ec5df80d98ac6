// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gischt {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double standard_gravity = 9.80665;         // m/s^2
inline constexpr double ambient_temperature = 293.15;       // K, 20 degrees Celsius
inline constexpr double stefan_boltzmann = 5.670374419e-8;  // W/(m^2 K^4)
inline constexpr double planck = 6.62607015e-34;            // J s
inline constexpr double light_speed = 299792458.0;          // m/s
inline constexpr double boltzmann = 1.380649e-23;           // J/K

constexpr double radians(double degrees) {
    return degrees * (pi / 180.0);
}

}  // namespace gischt
