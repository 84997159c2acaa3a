#include "app/common/print_result.h"

#include <type_traits>
#include <variant>

#include <fmt/format.h>

namespace patrol::app {
namespace {

io::Metrics cell_json(const io::TableValue& value) {
  return std::visit(
      [](const auto& content) {
        if constexpr (std::is_same_v<std::decay_t<decltype(content)>, std::monostate>) return io::Metrics();
        else return io::Metrics(content);
      },
      value);
}

}  // namespace

void print_result(ResultForm form, const std::string& text, const io::Metrics& json) {
  if (form == ResultForm::kText) fmt::print("{}", text);
  else fmt::print("{}\n", json.dump(2, ' ', false, io::Metrics::error_handler_t::replace));
}

io::Metrics to_json(const io::Table& table) {
  io::Metrics rows = io::Metrics::array();
  for (const auto& row : table.rows) {
    io::Metrics& object = rows.emplace_back(io::Metrics::object());
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i]] = cell_json(row[i]);
  }
  return rows;
}

}  // namespace patrol::app
