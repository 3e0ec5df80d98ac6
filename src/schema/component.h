// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schema/value.h"

namespace gischt {

struct Component;

// What is said about a parameter beside its key and its C++ member.
struct ParameterOptions {
    std::string unit = {};  // SI, as in "1/m"; empty for a pure number
    std::string help = {};  // one sentence without a full stop
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_open = false, max_open = false;  // the end itself is refused
    bool required = false;                    // must be written: there is no sensible default
    bool broadcast = false;                   // one number may stand for three equal ones
};

// The form that a parameter's value has in a scene file.
struct ParameterForm {
    enum class Type { Boolean, Integer, Real, String, Choice, Table };
    Type type = Type::Real;
    int count = 1;             // numbers in a vector
    bool list = false;         // any number of these
    bool keyframable = false;  // may be { t = [...], v = [...] }
    bool optional = false;     // unset by default
};

// A word that a parameter of type Choice may have.
struct ChoiceInfo {
    std::string word, help;
};

// The place of a value that is being read, for messages.
struct Place;

// One key of a component, with its C++ type erased. `object` is the struct that the component
// describes, not the member.
struct Parameter {
    std::string key;
    ParameterOptions options;
    ParameterForm form;
    std::vector<ChoiceInfo> choices;  // for Type::Choice
    const Component* component{};     // for Type::Table: what the table contains
    std::function<void(void* object, const Value&, const Place&)> read;
    std::function<std::optional<Value>(const void* object)> write;  // nothing when unset
};

struct Place {
    const std::string& table;  // the dotted name of the table, empty at the top level
    const Parameter& parameter;

    // Throws Error{Usage}: "'key' in [table] <fact>".
    [[noreturn]] void fail(const Location& at, std::string_view fact, std::string hint = {}) const;
};

// Given to a check across keys: fail("key", "must ...") throws Error{Usage} at the place where the
// key was written, or at the table's when the key is empty or has its default.
class Fail {
  public:
    Fail(const Value& table, const std::string& path) : table_(table), path_(path) {}
    [[noreturn]] void operator()(std::string_view key, std::string_view fact,
                                 std::string hint = {}) const;

  private:
    const Value& table_;
    const std::string& path_;
};

// One of the components that a selector key ("type") chooses from.
struct Alternative {
    std::string word;
    const Component* component{};
    std::function<void*(void* variant)> select;            // makes it the active one
    std::function<const void*(const void* variant)> held;  // null when another is active
};

// The table of a component, erased of its C++ type: either `parameters` and `checks`, or
// `alternatives`. Parser, messages, manual and JSON schema are all made from this.
struct Component {
    std::string name, help;
    std::vector<Parameter> parameters;
    std::vector<std::function<void(const void* object, const Fail&)>> checks;
    std::vector<Alternative> alternatives;
    std::string selector = "type";
    std::function<std::shared_ptr<void>()> make;  // an object with its defaults

    const Parameter* find(std::string_view key) const;
    const Alternative* find_alternative(std::string_view word) const;
    // Throws Error{Internal} when the key is there already.
    void append(Parameter parameter);
    // Takes over all parameters and checks of `part`, which describes a piece of the object.
    void adopt(const Component& part, std::function<void*(void*)> piece_of);
};

// Reads a table into an object that has its defaults: unknown keys, wrong types, values out of
// range, missing required keys and failed checks throw Error{Usage} with the exact location.
// `also_allowed` are keys that somebody else reads.
void read_component(const Component& component, void* object, const Value& value,
                    const std::string& path, const std::vector<std::string>& also_allowed = {});

// The object as a table with all its keys, those that are unset left out.
Value write_component(const Component& component, const void* object);

// The elements of a list of tables, a single table counting as one; throws Error{Usage} for
// anything else and for two elements of one `name`.
std::vector<const Value*> list_elements(const Value& value, const Place& place);

// "fluid.domain" from "fluid" and "domain".
std::string join_path(std::string_view table, std::string_view key);

}  // namespace gischt
