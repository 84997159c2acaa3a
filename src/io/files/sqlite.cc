#include "io/files/sqlite.h"

#include <unistd.h>

#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <sqlite3.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/output_error.h"

namespace patrol::io {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

/// Returns a quoted SQL identifier for any name.
std::string identifier(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

void check(bool is_fine, sqlite3* database) {
  if (is_fine) return;
  const int code = sqlite3_errcode(database);
  if (code == SQLITE_FULL || code == SQLITE_IOERR) throw OutputError(sqlite3_errmsg(database));
  throw InputError(sqlite3_errmsg(database));
}

void execute(sqlite3* database, const std::string& sql) {
  check(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK, database);
}

int bind(sqlite3_stmt* statement, int index, const TableValue& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) {
    return sqlite3_bind_text(statement, index, text->data(), static_cast<int>(text->size()), SQLITE_STATIC);
  }
  if (const auto* number = std::get_if<double>(&cell)) return sqlite3_bind_double(statement, index, *number);
  if (const auto* number = std::get_if<std::int64_t>(&cell)) return sqlite3_bind_int64(statement, index, *number);
  return sqlite3_bind_null(statement, index);
}

void write(sqlite3* database, const Table& table) {
  std::vector<std::string> columns;
  for (const std::string& column : table.columns) columns.push_back(identifier(column));
  execute(database, fmt::format("CREATE TABLE {} ({})", identifier(table.name), join(columns, ", ")));

  const std::vector<std::string> placeholders(table.columns.size(), "?");
  const std::string sql = fmt::format("INSERT INTO {} VALUES ({})", identifier(table.name), join(placeholders, ", "));
  sqlite3_stmt* raw = nullptr;
  check(sqlite3_prepare_v2(database, sql.c_str(), -1, &raw, nullptr) == SQLITE_OK, database);
  const Statement insert(raw, sqlite3_finalize);
  for (const std::vector<TableValue>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      check(bind(raw, static_cast<int>(i) + 1, row[i]) == SQLITE_OK, database);
    check(sqlite3_step(raw) == SQLITE_DONE && sqlite3_reset(raw) == SQLITE_OK, database);
  }
}

void write_all(const std::filesystem::path& file, const std::vector<Table>& tables) {
  sqlite3* raw = nullptr;
  const int opened = sqlite3_open(file.string().c_str(), &raw);
  const Database database(raw, sqlite3_close);
  check(opened == SQLITE_OK, raw);
  execute(raw, "PRAGMA journal_mode = OFF");  // safe: the database is a temporary file until it is complete
  execute(raw, "BEGIN");
  for (const Table& table : tables) write(raw, table);
  execute(raw, "COMMIT");
}

}  // namespace

void save_sqlite(const std::filesystem::path& file, const std::vector<Table>& tables) {
  const std::filesystem::path temporary = fmt::format("{}.{}.part", file.string(), ::getpid());
  std::error_code error;
  std::filesystem::remove(temporary, error);
  try {
    write_all(temporary, tables);
    std::filesystem::rename(temporary, file);
  } catch (const OutputError& failure) {
    std::filesystem::remove(temporary, error);
    throw OutputError(fmt::format("{}: cannot be written: {}", file.string(), failure.what()));
  } catch (const std::exception& failure) {
    std::filesystem::remove(temporary, error);
    throw InputError(fmt::format("{}: cannot be written: {}", file.string(), failure.what()));
  }
}

}  // namespace patrol::io
