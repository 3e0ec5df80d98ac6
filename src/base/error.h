// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <exception>
#include <span>
#include <string>
#include <string_view>

namespace gischt {

// What went wrong, in the classes that the command line turns into exit statuses.
enum class ErrorKind {
    Usage,      // bad scene, bad parameter, bad command line: exit status 2
    Input,      // an input file is missing, unreadable or broken: 3
    Resource,   // out of memory or disk: 4
    Cancelled,  // the user stopped the job: 130
    Internal,   // a bug
};

// The one exception of the library. `where` is a file, file:line:column or component; `what` the
// fact; `hint` how to mend it (may be empty). what() reads "where: what; hint".
class Error : public std::exception {
  public:
    Error(ErrorKind kind, std::string where, std::string what, std::string hint = {});

    ErrorKind kind() const { return kind_; }
    const std::string& where() const { return where_; }
    const std::string& fact() const { return what_; }
    const std::string& hint() const { return hint_; }
    const char* what() const noexcept override { return text_.c_str(); }

  private:
    ErrorKind kind_;
    std::string where_, what_, hint_, text_;
};

// The word of `valid` nearest to `word` by edit distance with transpositions (Damerau 1964), or an
// empty string when none is closer than about a third of the word's length.
std::string nearest_word(std::string_view word, std::span<const std::string> valid);

// "did you mean 'x'?" when a near word exists, else "valid: a, b, c".
std::string hint_for(std::string_view word, std::span<const std::string> valid);

}  // namespace gischt

// A precondition that only a bug in gischt can break; checked in debug builds.
#define GISCHT_ASSERT(condition) assert(condition)
