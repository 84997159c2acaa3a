#include "io/json/table_json.h"

#include <type_traits>
#include <variant>

namespace patrol::io {
namespace {

Metrics cell_json(const TableValue& value) {
  return std::visit(
      [](const auto& content) {
        if constexpr (std::is_same_v<std::decay_t<decltype(content)>, std::monostate>) return Metrics();
        else return Metrics(content);
      },
      value);
}

}  // namespace

Metrics to_json(const Table& table) {
  Metrics rows = Metrics::array();
  for (const auto& row : table.rows) {
    Metrics& object = rows.emplace_back(Metrics::object());
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i]] = cell_json(row[i]);
  }
  return rows;
}

}  // namespace patrol::io
