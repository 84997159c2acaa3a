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

/// A prepared statement. What comes from outside only ever gets into it through `bind`.
class Statement {
 public:
  /// Starts anew with these for ?1, ?2, ...
  template <typename... Values>
  Statement& bind(const Values&... values) {
    reset();
    int place = 0;
    (bind_one(++place, values), ...);
    return *this;
  }
  /// True: there is a row.
  bool step();
  void run() { while (step()) {} }

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
  void bind_one(int place, std::int64_t value);
  void bind_one(int place, int value) { bind_one(place, static_cast<std::int64_t>(value)); }
  void bind_one(int place, double value);
  void bind_one(int place, const std::string& value);
  void bind_one(int place, const char* value) { bind_one(place, std::string(value)); }

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// An SQLite database with a write-ahead log that reaches the disk with every transaction: what was committed is there after a power
/// cut. Whatever fails later throws std::runtime_error.
class Database {
 public:
  /// Creates the file, readable by its owner only, when it does not exist; its log and journal get the same mode. Throws InputError when it cannot be opened or is not a database.
  explicit Database(const std::filesystem::path& file);

  Statement prepare(std::string_view sql) { return Statement(database_.get(), sql); }
  /// One that is kept for the next time; for what is run to its end.
  Statement& prepared(const std::string& sql);
  /// The first column of the first row, if there is one.
  template <typename... Values>
  std::optional<std::int64_t> find_integer(const std::string& sql, const Values&... values) {
    Statement& statement = prepared(sql);
    std::optional<std::int64_t> found;
    if (statement.bind(values...).step()) found = statement.integer(0);
    statement.reset();
    return found;
  }
  void execute(const char* sql);
  int changes() const;  ///< rows of the last statement
  std::int64_t last_row() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
  std::map<std::string, Statement> prepared_;
};

/// Everything until `commit`, or nothing.
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
