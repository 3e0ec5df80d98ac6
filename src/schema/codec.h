// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/keyframes.h"
#include "math/vec.h"
#include "schema/component.h"

namespace gischt {

template <class M, class... Types>
concept OneOf = (std::same_as<M, Types> || ...);

// The C++ types that a parameter may have, beside enums and components.
template <class M>
concept PlainType = OneOf<M, bool, int, std::int64_t, float, double, std::string, Vec2i, Vec2f,
                          Vec2d, Vec3i, Vec3f, Vec3d, Keyed<double>, Keyed<float>, Keyed<Vec3d>,
                          Keyed<Vec3f>, std::vector<int>, std::vector<double>, std::vector<float>,
                          std::vector<std::string>, std::vector<Vec2d>, std::vector<Vec3d>>;

// How one type looks in a scene file, is read (with the parameter's range) and written. Defined in
// codec.cpp for every PlainType.
template <class M>
struct Codec {
    static ParameterForm form();
    static void read(M& out, const Value& value, const Place& place);
    static Value write(const M& in);
};

// std::optional<X> reads as X does and is unset by default.
template <class M>
struct Unwrapped {
    using type = M;
    static constexpr bool optional = false;
};
template <class M>
struct Unwrapped<std::optional<M>> {
    using type = M;
    static constexpr bool optional = true;
};

// Reads the index of one of a parameter's choices; throws Error{Usage} with the nearest word.
std::size_t read_choice(const Value& value, const Place& place);

}  // namespace gischt
