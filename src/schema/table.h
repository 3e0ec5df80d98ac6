// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>

#include "schema/codec.h"
#include "schema/component.h"

namespace gischt {

// A component that describes objects of type T. It must outlive every table that refers to it: make
// it `static const` in a function.
template <class T>
struct TypedComponent : Component {
    TypedComponent(std::string component_name, std::string component_help) {
        name = std::move(component_name);
        help = std::move(component_help);
        make = [] { return std::static_pointer_cast<void>(std::make_shared<T>()); };
    }
};

// A word for a value of an enum.
template <class E>
struct Choice {
    std::string word;
    E value;
    std::string help = {};
};

// The parameters of T, each declared once. The defaults are those of a default-constructed T.
//
//     const Table<Medium>& medium_table() {
//         static const Table<Medium> table =
//             Table<Medium>("medium", "What the fluid does to light")
//                 .add("g", &Medium::g,
//                      {.help = "Mean cosine of scattering", .min = -1, .max = 1,
//                       .min_open = true, .max_open = true})
//                 .choice("phase", &Medium::phase, {{"hg", Phase::Hg}, {"schlick",
//                 Phase::Schlick}}) .sub("grid", &Medium::grid, grid_table()) .check([](const
//                 Medium& m, const Fail& fail) {
//                     if (m.a > m.b) fail("a", "must not be larger than 'b'");
//                 });
//         return table;
//     }
template <class T>
class Table : public TypedComponent<T> {
  public:
    using TypedComponent<T>::TypedComponent;

    // A PlainType of codec.h or an optional of one. The member may be one of a base class of T.
    template <class M, class C>
    Table& add(std::string key, M C::*member, ParameterOptions options = {});

    // An enum (or optional of one) with its words.
    template <class E, class C>
    Table& choice(std::string key, E C::*member,
                  std::vector<Choice<std::type_identity_t<typename Unwrapped<E>::type>>> choices,
                  ParameterOptions options = {});

    // A table within the table: M is what `component` describes, or an optional of it. `component`
    // is a Table or Variants.
    template <class M, class C, class P>
    Table& sub(std::string key, M C::*member, const TypedComponent<P>& component,
               ParameterOptions options = {});
    template <class M, class C, class P>
    Table& sub(std::string, M C::*, const TypedComponent<P>&&, ParameterOptions = {}) = delete;

    // An array of tables; a single table is a list of one. Every element may have a unique `name`,
    // declared in its table or not.
    template <class C, class P>
    Table& list(std::string key, std::vector<P> C::*member, const TypedComponent<P>& component,
                ParameterOptions options = {});
    template <class C, class P>
    Table& list(std::string, std::vector<P> C::*, const TypedComponent<P>&&,
                ParameterOptions = {}) = delete;

    // The keys of a member (or of a base class), as if they were declared here.
    template <class C, class P>
    Table& flat(P C::*member, const Table<P>& component);
    template <class Base>
    Table& base(const Table<Base>& component);

    // A condition across keys: f(const T&, const Fail&), called after a table was read.
    template <class F>
    Table& check(F f) {
        this->checks.push_back(
            [f](const void* object, const Fail& fail) { f(*static_cast<const T*>(object), fail); });
        return *this;
    }

  private:
    static T& cast(void* object) { return *static_cast<T*>(object); }
    static const T& cast(const void* object) { return *static_cast<const T*>(object); }
};

// A std::variant V whose alternative is chosen by a key of the table, "type" unless another is
// given. Without the key, a single variant keeps the alternative of its default (with that
// default's values); an element of a list must have the key.
//
//     static const Variants<Light> lights = Variants<Light>("light", "...")
//         .add("sun", sun_table()).add("point", point_table());
template <class V>
class Variants : public TypedComponent<V> {
  public:
    Variants(std::string component_name, std::string component_help,
             std::string selector_key = "type")
        : TypedComponent<V>(std::move(component_name), std::move(component_help)) {
        this->selector = std::move(selector_key);
    }

    template <class A>
    Variants& add(std::string word, const TypedComponent<A>& table) {
        const auto select = [](void* variant) -> void* {
            V& v = *static_cast<V*>(variant);
            return std::holds_alternative<A>(v) ? &std::get<A>(v) : &v.template emplace<A>();
        };
        const auto held = [](const void* variant) -> const void* {
            return std::get_if<A>(static_cast<const V*>(variant));
        };
        this->alternatives.push_back({std::move(word), &table, select, held});
        return *this;
    }
    template <class A>
    Variants& add(std::string, const TypedComponent<A>&&) = delete;
};

// The object that a table (of a scene file, say) describes. `path` is the name in messages, by
// default the component's; empty for the top level of a file.
template <class T>
T read(const Value& value, const TypedComponent<T>& component, const std::string& path) {
    T object;
    read_component(component, &object, value, path);
    return object;
}
template <class T>
T read(const Value& value, const TypedComponent<T>& component) {
    return read(value, component, component.name);
}

// The same on top of the values that an object has: for presets and editors. Keys that are not in
// `value` stay; lists are replaced. After an error the object is partly read.
template <class T>
void read_into(T& object, const Value& value, const TypedComponent<T>& component,
               const std::string& path) {
    read_component(component, &object, value, path);
}

// The object as a table with all keys that are set; read() of it gives the object again.
template <class T>
Value to_value(const T& object, const TypedComponent<T>& component) {
    return write_component(component, &object);
}

template <class T>
template <class M, class C>
Table<T>& Table<T>::add(std::string key, M C::*member, ParameterOptions options) {
    using Plain = typename Unwrapped<M>::type;
    static_assert(PlainType<Plain>, "see PlainType in schema/codec.h; enums take choice()");
    Parameter p;
    p.key = std::move(key);
    p.options = std::move(options);
    p.form = Codec<Plain>::form();
    p.form.optional = Unwrapped<M>::optional;
    p.read = [member](void* object, const Value& value, const Place& place) {
        if constexpr (Unwrapped<M>::optional) {
            Codec<Plain>::read((cast(object).*member).emplace(), value, place);
        } else {
            Codec<Plain>::read(cast(object).*member, value, place);
        }
    };
    p.write = [member](const void* object) -> std::optional<Value> {
        if constexpr (Unwrapped<M>::optional) {
            const M& held = cast(object).*member;
            return held ? std::optional<Value>(Codec<Plain>::write(*held)) : std::nullopt;
        } else {
            return Codec<Plain>::write(cast(object).*member);
        }
    };
    this->append(std::move(p));
    return *this;
}

template <class T>
template <class E, class C>
Table<T>& Table<T>::choice(
    std::string key, E C::*member,
    std::vector<Choice<std::type_identity_t<typename Unwrapped<E>::type>>> choices,
    ParameterOptions options) {
    Parameter p;
    p.key = std::move(key);
    p.options = std::move(options);
    p.form = {.type = ParameterForm::Type::Choice, .optional = Unwrapped<E>::optional};
    for (const auto& c : choices) p.choices.push_back({c.word, c.help});
    p.read = [member, choices](void* object, const Value& value, const Place& place) {
        cast(object).*member = choices[read_choice(value, place)].value;
    };
    p.write = [member, choices](const void* object) -> std::optional<Value> {
        for (const auto& c : choices) {
            if (cast(object).*member == c.value) return Value(c.word);
        }
        return std::nullopt;
    };
    this->append(std::move(p));
    return *this;
}

template <class T>
template <class M, class C, class P>
Table<T>& Table<T>::sub(std::string key, M C::*member, const TypedComponent<P>& component,
                        ParameterOptions options) {
    static_assert(std::is_same_v<typename Unwrapped<M>::type, P>);
    Parameter p;
    p.key = std::move(key);
    p.options = std::move(options);
    p.form = {.type = ParameterForm::Type::Table, .optional = Unwrapped<M>::optional};
    p.component = &component;
    p.read = [member, &component](void* object, const Value& value, const Place& place) {
        const std::string path = join_path(place.table, place.parameter.key);
        M& m = cast(object).*member;
        if constexpr (Unwrapped<M>::optional) {
            read_component(component, m ? &*m : &m.emplace(), value, path);
        } else {
            read_component(component, &m, value, path);
        }
    };
    p.write = [member, &component](const void* object) -> std::optional<Value> {
        const M& m = cast(object).*member;
        if constexpr (Unwrapped<M>::optional) {
            return m ? std::optional<Value>(write_component(component, &*m)) : std::nullopt;
        } else {
            return write_component(component, &m);
        }
    };
    this->append(std::move(p));
    return *this;
}

template <class T>
template <class C, class P>
Table<T>& Table<T>::list(std::string key, std::vector<P> C::*member,
                         const TypedComponent<P>& component, ParameterOptions options) {
    Parameter p;
    p.key = std::move(key);
    p.options = std::move(options);
    p.form = {.type = ParameterForm::Type::Table, .list = true};
    p.component = &component;
    p.read = [member, &component](void* object, const Value& value, const Place& place) {
        const std::string path = join_path(place.table, place.parameter.key);
        std::vector<P> elements;
        for (const Value* element : list_elements(value, place)) {
            read_component(component, &elements.emplace_back(), *element, path, {"name"});
        }
        cast(object).*member = std::move(elements);
    };
    p.write = [member, &component](const void* object) -> std::optional<Value> {
        Value::Array elements;
        for (const P& element : cast(object).*member) {
            elements.push_back(write_component(component, &element));
        }
        return Value(std::move(elements));
    };
    this->append(std::move(p));
    return *this;
}

template <class T>
template <class C, class P>
Table<T>& Table<T>::flat(P C::*member, const Table<P>& component) {
    this->adopt(component, [member](void* object) -> void* { return &(cast(object).*member); });
    return *this;
}

template <class T>
template <class Base>
Table<T>& Table<T>::base(const Table<Base>& component) {
    static_assert(std::is_base_of_v<Base, T>);
    this->adopt(component, [](void* object) -> void* { return static_cast<Base*>(&cast(object)); });
    return *this;
}

}  // namespace gischt
