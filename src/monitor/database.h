#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace patrol::monitor {

/// Prepared statement. External values enter it only through `bind`.
class Statement {
 public:
  /// Resets the statement and binds ?1, ?2, ...
  template <typename... Values>
  Statement& bind(const Values&... values) {
    reset();
    int index = 0;
    (bind_one(++index, values), ...);
    return *this;
  }
  /// Returns true when there is a row.
  bool step();
  void run() {
    while (step()) {}
  }

  std::int64_t integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;
  bool is_null(int column) const;
  int num_columns() const;
  std::string name(int column) const;
  enum class Type { kNull, kInteger, kNumber, kText };
  Type type(int column) const;

 private:
  friend class Database;
  Statement(sqlite3* database, std::string_view sql);
  void reset();
  void check(int code) const;
  void bind_one(int index, std::int64_t value);
  void bind_one(int index, int value) { bind_one(index, static_cast<std::int64_t>(value)); }
  void bind_one(int index, double value);
  void bind_one(int index, const std::string& value);
  void bind_one(int index, const char* value) { bind_one(index, std::string(value)); }

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// SQLite database with a write-ahead log that is synchronized with every transaction: committed data survive a power
/// failure. Throws std::runtime_error on later errors.
class Database {
 public:
  /// Opens the file, or creates it readable by its owner only; its log and journal have the same mode. Throws
  /// InputError when it cannot be opened or is not a database.
  explicit Database(const std::filesystem::path& file);

  Statement prepare(std::string_view sql) { return {database_.get(), sql}; }
  /// Cached statement for repeated use. Must be run to its end before the next use.
  Statement& prepared(const std::string& sql);
  /// First column of the first row, none without a row.
  template <typename... Values>
  std::optional<std::int64_t> find_integer(const std::string& sql, const Values&... values) {
    Statement& statement = prepared(sql);
    std::optional<std::int64_t> found;
    if (statement.bind(values...).step()) found = statement.integer(0);
    statement.reset();
    return found;
  }
  void execute(const char* sql);
  int changes() const;  ///< number of rows changed by the last statement
  /// Row id of the last insertion.
  std::int64_t last_row() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
  std::map<std::string, Statement> prepared_;
};

/// Transaction that is rolled back unless `commit` is called.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool is_open_ = true;
};

}  // namespace patrol::monitor
