#include "importer/assumptions.h"

#include <fmt/format.h>

#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Returns text for a cell of a Markdown table.
std::string table_cell(const std::string& text) {
  std::string cell;
  for (const char c : io::on_one_line(text)) {
    if (c == '|') cell += '\\';
    if (c == '<') cell += "&lt;";
    else cell += c;
  }
  return cell;
}

}  // namespace

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string to_markdown(const std::vector<Assumption>& assumptions, const std::string& none) {
  if (assumptions.empty()) return none;
  std::string text = "| subject | assumption | overridden by |\n| --- | --- | --- |\n";
  for (const Assumption& row : assumptions) {
    text +=
        fmt::format("| {} | {} | {} |\n", table_cell(row.subject), table_cell(row.text), table_cell(row.override_with));
  }
  return text;
}

}  // namespace patrol::importer
