#include "monitor/database.h"

#include <fcntl.h>
#include <unistd.h>

#include <stdexcept>

#include <fmt/format.h>
#include <sqlite3.h>

#include "core/error.h"

namespace patrol::monitor {

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
  sqlite3_stmt* statement = nullptr;
  check(sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
  statement_.reset(statement);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void Statement::check(int code) const {
  if (code != SQLITE_OK) throw std::runtime_error(fmt::format("database: {}", sqlite3_errmsg(database_)));
}

void Statement::reset() {
  sqlite3_reset(statement_.get());  // returns the error of the last step again
  sqlite3_clear_bindings(statement_.get());
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) check(code);
  sqlite3_reset(statement_.get());
  return false;
}

void Statement::bind_one(int index, std::int64_t value) { check(sqlite3_bind_int64(statement_.get(), index, value)); }
void Statement::bind_one(int index, double value) { check(sqlite3_bind_double(statement_.get(), index, value)); }
void Statement::bind_one(int index, const std::string& value) {
  check(sqlite3_bind_text(statement_.get(), index, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT));
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Statement::number(int column) const { return sqlite3_column_double(statement_.get(), column); }
bool Statement::is_null(int column) const { return type(column) == Type::kNull; }
int Statement::num_columns() const { return sqlite3_column_count(statement_.get()); }
std::string Statement::name(int column) const { return sqlite3_column_name(statement_.get(), column); }
Statement::Type Statement::type(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_NULL:
      return Type::kNull;
    case SQLITE_INTEGER:
      return Type::kInteger;
    case SQLITE_FLOAT:
      return Type::kNumber;
    default:
      return Type::kText;
  }
}
std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return bytes == nullptr
             ? ""
             : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

namespace {

/// Creates the file with mode 0600; SQLite would create it readable by all.
void create_for_owner(const std::filesystem::path& file) {
  const int created = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (created >= 0) ::close(created);
}

}  // namespace

Database::Database(const std::filesystem::path& file) {
  create_for_owner(file);
  sqlite3* database = nullptr;
  const int opened = sqlite3_open(file.string().c_str(), &database);
  database_.reset(database);
  try {
    if (opened != SQLITE_OK) throw std::runtime_error(sqlite3_errmsg(database));
    execute("PRAGMA journal_mode = WAL");
    execute("PRAGMA synchronous = FULL");
    execute("PRAGMA cache_size = -8000");  // KiB
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("{}: cannot open: {}", file.string(), error.what()));
  }
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

void Database::execute(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error(fmt::format("database: {}", sqlite3_errmsg(database_.get())));
  }
}

Statement& Database::prepared(const std::string& sql) {
  const auto there = prepared_.find(sql);
  return there != prepared_.end() ? there->second : prepared_.emplace(sql, prepare(sql)).first->second;
}

int Database::changes() const { return sqlite3_changes(database_.get()); }
std::int64_t Database::last_row() const { return sqlite3_last_insert_rowid(database_.get()); }

Transaction::~Transaction() {
  if (!is_open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const std::runtime_error&) {  // already rolled back by SQLite
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  is_open_ = false;
}

}  // namespace patrol::monitor
