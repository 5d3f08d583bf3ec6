// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace spherule {

// The names in a source, found by their neighbours alone: no types are resolved. In doubt a name is
// declared.
struct SourceNames {
  // Declared anywhere: types, constants, variables, functions, parameters, enumerators.
  std::set<std::string, std::less<>> declared;
  // Types, constants (kName) and functions that are declared on a line without indent, so in a
  // namespace. A type that is only named (`class Name;`) is none of them.
  std::set<std::string, std::less<>> offered;
  std::set<std::string, std::less<>> offered_functions;
  // Used, but not as a member (`a.name`) or as a name of another project (`std::name`); `called`
  // are those of them that a bracket follows. Some words of the language are among them.
  std::set<std::string, std::less<>> used;
  std::set<std::string, std::less<>> called;
  // Names behind `scope::`, by the first scope: `size` of std::ranges::size for std. Members
  // (`a.name`) are those of the scope `.`.
  std::map<std::string, std::set<std::string>, std::less<>> of_scope;
  // Namespaces in which something is declared, the first part of each.
  std::set<std::string, std::less<>> namespaces;
};

SourceNames names_in(std::string_view text);

}  // namespace spherule
