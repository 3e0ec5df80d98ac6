// SPDX-License-Identifier: Apache-2.0
#include "schema/codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <type_traits>

#include "base/error.h"
#include "schema/describe.h"

namespace gischt {

namespace {

[[noreturn]] void fail_type(const Value& value, const Place& place) {
    const ParameterForm& form = place.parameter.form;
    const bool keyframes = value.is_table() && value.find("t");
    if (keyframes && !form.keyframable) place.fail(value.at, "cannot be keyframed");
    std::string must = type_text(place.parameter);
    if (form.type != ParameterForm::Type::Boolean && form.count == 1) must = "a " + must;
    // 2.5 for a whole number: the value says more than its type.
    const std::string is = value.kind() == Value::Kind::Real ? fmt::format("{}", value.number())
                                                             : std::string(value.describe());
    place.fail(value.at, fmt::format("must be {}, not {}", must, is));
}

void check_range(double number, const Location& at, const Place& place) {
    const ParameterOptions& o = place.parameter.options;
    if (!std::isfinite(number)) place.fail(at, "must be a finite number");
    const bool below = o.min_open ? number <= o.min : number < o.min;
    const bool above = o.max_open ? number >= o.max : number > o.max;
    if (!below && !above) return;
    const std::string unit = o.unit.empty() ? "" : " " + o.unit;
    place.fail(at, fmt::format("must be {}{}, not {}", range_text(o), unit, number));
}

// One number, string or truth value, from any scalar.
template <class S>
void read_scalar(S& out, const Value& value, const Place& place) {
    if constexpr (std::is_same_v<S, bool>) {
        if (value.kind() != Value::Kind::Boolean) fail_type(value, place);
        out = value.boolean();
    } else if constexpr (std::is_same_v<S, std::string>) {
        if (!value.is_string()) fail_type(value, place);
        out = value.string();
    } else if constexpr (std::is_integral_v<S>) {
        if (value.kind() != Value::Kind::Integer) fail_type(value, place);
        check_range(value.number(), value.at, place);
        const std::int64_t number = value.integer();
        if (number < std::numeric_limits<S>::min() || number > std::numeric_limits<S>::max()) {
            place.fail(value.at, fmt::format("is too large a number: {}", number));
        }
        out = static_cast<S>(number);
    } else {
        if (!value.is_number()) fail_type(value, place);
        check_range(value.number(), value.at, place);
        if (std::abs(value.number()) > static_cast<double>(std::numeric_limits<S>::max())) {
            place.fail(value.at, fmt::format("is too large a number: {}", value.number()));
        }
        out = static_cast<S>(value.number());
    }
}

template <class S>
Value write_scalar(const S& in) {
    if constexpr (std::is_same_v<S, float>) {
        // The shortest decimal that is this float: 0.1, not 0.10000000149.
        return Value(std::stod(fmt::format("{}", in)));
    } else {
        return Value(in);
    }
}

template <class S>
constexpr ParameterForm::Type type_of() {
    if (std::is_same_v<S, bool>) return ParameterForm::Type::Boolean;
    if (std::is_same_v<S, std::string>) return ParameterForm::Type::String;
    return std::is_integral_v<S> ? ParameterForm::Type::Integer : ParameterForm::Type::Real;
}

const Value::Array& array_of(const Value& value, std::size_t count, const Place& place) {
    if (!value.is_array()) fail_type(value, place);
    if (value.array().size() != count) {
        place.fail(value.at,
                   fmt::format("must be {} numbers, not {}", count, value.array().size()));
    }
    return value.array();
}

// Form<M>: how values of type M are read and written, from the inside out.
template <class S>
struct Form {
    static ParameterForm form() { return {.type = type_of<S>()}; }
    static void read(S& out, const Value& value, const Place& place) {
        read_scalar(out, value, place);
    }
    static Value write(const S& in) { return write_scalar(in); }
};

template <class S>
struct Form<Vec2<S>> {
    static ParameterForm form() { return {.type = type_of<S>(), .count = 2}; }
    static void read(Vec2<S>& out, const Value& value, const Place& place) {
        const Value::Array& a = array_of(value, 2, place);
        read_scalar(out.x, a[0], place);
        read_scalar(out.y, a[1], place);
    }
    static Value write(const Vec2<S>& in) {
        return Value::Array{write_scalar(in.x), write_scalar(in.y)};
    }
};

template <class S>
struct Form<Vec3<S>> {
    static ParameterForm form() { return {.type = type_of<S>(), .count = 3}; }
    static void read(Vec3<S>& out, const Value& value, const Place& place) {
        if (place.parameter.options.broadcast && value.is_number()) {
            S all{};
            read_scalar(all, value, place);
            out = Vec3<S>(all);
            return;
        }
        const Value::Array& a = array_of(value, 3, place);
        for (int axis = 0; axis < 3; ++axis) {
            read_scalar(out[axis], a[static_cast<std::size_t>(axis)], place);
        }
    }
    static Value write(const Vec3<S>& in) {
        return Value::Array{write_scalar(in.x), write_scalar(in.y), write_scalar(in.z)};
    }
};

template <class E>
struct Form<std::vector<E>> {
    static ParameterForm form() {
        ParameterForm form = Form<E>::form();
        form.list = true;
        return form;
    }
    static void read(std::vector<E>& out, const Value& value, const Place& place) {
        if (!value.is_array()) fail_type(value, place);
        std::vector<E> elements;
        for (const Value& element : value.array()) {
            Form<E>::read(elements.emplace_back(), element, place);
        }
        out = std::move(elements);
    }
    static Value write(const std::vector<E>& in) {
        Value::Array elements;
        for (const E& element : in) elements.push_back(Form<E>::write(element));
        return elements;
    }
};

const std::vector<std::string> keyframe_keys = {"t", "v", "interpolation"};
const std::vector<std::string> interpolation_words = {"step", "linear", "smooth"};

KeyInterpolation read_interpolation(const Value& value, const Place& place) {
    if (!value.is_string()) place.fail(value.at, "needs a string as 'interpolation'");
    const std::string& word = value.string();
    const auto at = std::find(interpolation_words.begin(), interpolation_words.end(), word);
    if (at == interpolation_words.end()) {
        place.fail(value.at, "has an unknown interpolation '" + word + "'",
                   hint_for(word, interpolation_words));
    }
    return static_cast<KeyInterpolation>(at - interpolation_words.begin());
}

std::vector<double> read_times(const Value& value, const Place& place) {
    std::vector<double> times;
    for (const Value& element : value.array()) {
        if (!element.is_number() || !std::isfinite(element.number())) {
            place.fail(element.at, "needs finite numbers of seconds as key times 't'");
        }
        if (!times.empty() && element.number() <= times.back()) {
            place.fail(element.at, fmt::format("has key times 't' that do not ascend: {} after {}",
                                               element.number(), times.back()));
        }
        times.push_back(element.number());
    }
    return times;
}

// The lists t and v of a keyframe table: there, lists, of one length and not empty.
void check_keyframes(const Value& table, const Place& place) {
    for (const Value::Member& m : table.members()) {
        if (std::find(keyframe_keys.begin(), keyframe_keys.end(), m.key) == keyframe_keys.end()) {
            place.fail(m.key_at, "has an unknown key '" + m.key + "' in its keyframes",
                       hint_for(m.key, keyframe_keys));
        }
    }
    const Value *t = table.find("t"), *v = table.find("v");
    const char* example = "as in { t = [0, 1], v = [0, 5] }";
    if (!t || !t->is_array()) place.fail(table.at, "needs a list of key times 't'", example);
    if (!v || !v->is_array()) place.fail(table.at, "needs a list of values 'v'", example);
    if (t->array().empty()) place.fail(t->at, "needs at least one keyframe");
    if (t->array().size() != v->array().size()) {
        place.fail(v->at, fmt::format("has {} key times 't' but {} values 'v'", t->array().size(),
                                      v->array().size()));
    }
}

template <class E>
struct Form<Keyed<E>> {
    static ParameterForm form() {
        ParameterForm form = Form<E>::form();
        form.keyframable = true;
        return form;
    }
    static void read(Keyed<E>& out, const Value& value, const Place& place) {
        if (!value.is_table()) {
            E constant{};
            Form<E>::read(constant, value, place);
            out = Keyed<E>(constant);
            return;
        }
        check_keyframes(value, place);
        std::vector<E> values;
        for (const Value& element : value.find("v")->array()) {
            Form<E>::read(values.emplace_back(), element, place);
        }
        const Value* word = value.find("interpolation");
        out = Keyed<E>(read_times(*value.find("t"), place), std::move(values),
                       word ? read_interpolation(*word, place) : KeyInterpolation::Linear);
    }
    static Value write(const Keyed<E>& in) {
        if (in.t.empty()) return Form<E>::write(in.v.front());
        Value table;
        table.set("t", Form<std::vector<double>>::write(in.t));
        table.set("v", Form<std::vector<E>>::write(in.v));
        if (in.interpolation != KeyInterpolation::Linear) {
            table.set("interpolation",
                      interpolation_words[static_cast<std::size_t>(in.interpolation)]);
        }
        return table;
    }
};

}  // namespace

template <class M>
ParameterForm Codec<M>::form() {
    return Form<M>::form();
}
template <class M>
void Codec<M>::read(M& out, const Value& value, const Place& place) {
    Form<M>::read(out, value, place);
}
template <class M>
Value Codec<M>::write(const M& in) {
    return Form<M>::write(in);
}

template struct Codec<bool>;
template struct Codec<int>;
template struct Codec<std::int64_t>;
template struct Codec<float>;
template struct Codec<double>;
template struct Codec<std::string>;
template struct Codec<Vec2i>;
template struct Codec<Vec2f>;
template struct Codec<Vec2d>;
template struct Codec<Vec3i>;
template struct Codec<Vec3f>;
template struct Codec<Vec3d>;
template struct Codec<Keyed<float>>;
template struct Codec<Keyed<double>>;
template struct Codec<Keyed<Vec3f>>;
template struct Codec<Keyed<Vec3d>>;
template struct Codec<std::vector<int>>;
template struct Codec<std::vector<float>>;
template struct Codec<std::vector<double>>;
template struct Codec<std::vector<std::string>>;
template struct Codec<std::vector<Vec2d>>;
template struct Codec<std::vector<Vec3d>>;

std::size_t read_choice(const Value& value, const Place& place) {
    std::vector<std::string> words;
    for (const ChoiceInfo& c : place.parameter.choices) words.push_back(c.word);
    if (!value.is_string()) {
        place.fail(value.at,
                   fmt::format("must be {}, not {}", type_text(place.parameter), value.describe()));
    }
    const auto at = std::find(words.begin(), words.end(), value.string());
    if (at == words.end()) {
        place.fail(value.at, "cannot be '" + value.string() + "'", hint_for(value.string(), words));
    }
    return static_cast<std::size_t>(at - words.begin());
}

}  // namespace gischt
