#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace patrol::io {

/// Content of a table cell; monostate: no value.
using TableValue = std::variant<std::monostate, std::int64_t, double, std::string>;

struct Table {
  std::string name;
  std::vector<std::string> columns;
  std::vector<std::vector<TableValue>> rows;  ///< [row][column]
};

}  // namespace patrol::io
