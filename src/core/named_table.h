#pragma once

#include <cstddef>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/text.h"

/// Tables of named choices: enumerators with their texts, algorithms with their factories. Each family has one table.
/// Parsing, JSON, settings validation (`one_of` of core/settings.h) and documentation (`patrol list`) derive from that
/// table.
namespace patrol {

/// Row of a table of enumerators.
template <typename Value>
struct NamedValue {
  Value value;
  std::string_view name;     ///< text in files, settings and messages
  std::string_view summary;  ///< one line of documentation
};

/// Row of a table of algorithms. `make` builds the algorithm from the settings of its family.
template <typename Make>
struct NamedFactory {
  std::string_view name;     ///< text in settings and on the command line
  std::string_view summary;  ///< one line of documentation
  Make* make;
};

/// A range of rows that have at least a `name` and a `summary`.
template <typename Table>
concept NamedTable = std::ranges::forward_range<const Table> && requires(const Table& table) {
  { std::ranges::begin(table)->name } -> std::convertible_to<std::string_view>;
  { std::ranges::begin(table)->summary } -> std::convertible_to<std::string_view>;
};

/// Whether row i holds the enumerator of value i: precondition of `row_of`. For use in a static_assert next to the
/// table.
template <NamedTable Table>
constexpr bool is_in_order(const Table& table) {
  std::size_t index = 0;
  for (const auto& row : table) {
    if (static_cast<std::size_t>(row.value) != index++) return false;
  }
  return true;
}

/// Row of an enumerator.
template <NamedTable Table, typename Value>
constexpr const auto& row_of(const Table& table, Value value) {
  return table[static_cast<std::size_t>(value)];
}

/// Row of that name; nullptr if the table has none.
template <NamedTable Table>
constexpr auto* find_named(const Table& table, std::string_view name) {
  for (const auto& row : table) {
    if (row.name == name) return &row;
  }
  return static_cast<decltype(&*std::ranges::begin(table))>(nullptr);
}

/// Names in the order of the table.
template <NamedTable Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& row : table) names.emplace_back(row.name);
  return names;
}

/// Row of that name. Throws InputError "<what> = <name>: must be one of ..." if the table has none.
template <NamedTable Table>
const auto& row_named(const Table& table, std::string_view name, const std::string& what) {
  if (const auto* row = find_named(table, name)) return *row;
  throw InputError(what + " = " + std::string(name) + ": must be one of " + join(names_of(table), ", "));
}

}  // namespace patrol
