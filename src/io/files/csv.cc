#include "io/files/csv.h"

#include <fmt/format.h>

#include "io/files/atomic_file.h"

namespace patrol::io {
namespace {

std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string text_of(const TableValue& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return quoted_cell(*text);
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  if (const auto* number = std::get_if<std::int64_t>(&cell)) return fmt::format("{}", *number);
  return "";
}

}  // namespace

std::string to_csv(const Table& table) {
  std::string text;
  const auto add_line = [&text](const auto& fields, const auto& to_text) {
    const char* separator = "";
    for (const auto& field : fields) {
      text += separator;
      text += to_text(field);
      separator = ",";
    }
    text += "\r\n";
  };
  add_line(table.columns, quoted_cell);
  for (const std::vector<TableValue>& row : table.rows) add_line(row, text_of);
  return text;
}

void save_csv(const std::filesystem::path& file, const Table& table) { save_text(file, to_csv(table)); }

}  // namespace patrol::io
