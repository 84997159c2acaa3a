#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "monitor/database.h"
#include "monitor/folder_lock.h"
#include "monitor/result.h"

namespace patrol::monitor {

/// What became of a result that was handed in.
enum class Stored {
  kNew,
  kKnown,     ///< it was there already, the same
  kConflict,  ///< another one of that id is there; nothing was changed
};

enum class Acknowledged { kDone, kAlready, kUnknown };

/// Keeps results: each id once, for good once `add` returns. Beside them it keeps what the page asks for again and again
/// (views.h), in the same transaction.
class Store {
 public:
  /// Made when it is not there. Throws InputError when it cannot be opened, or another process has it open.
  explicit Store(const std::filesystem::path& folder);

  /// All in one transaction: on an exception nothing is stored.
  std::vector<Stored> add(const std::vector<Result>& results, std::int64_t received_ms);

  Acknowledged acknowledge(std::int64_t finding, const std::string& who, const std::string& note, std::int64_t now_ms);

  /// For the queries (queries.h).
  Database& database() { return database_; }

 private:
  Stored add_one(const Result& result, std::int64_t received_ms, std::int64_t revision);
  std::int64_t next_revision();

  FolderLock lock_;
  Database database_;
};

}  // namespace patrol::monitor
