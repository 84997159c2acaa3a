#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "monitor/database.h"
#include "monitor/folder_lock.h"
#include "monitor/result.h"

namespace patrol::monitor {

/// Outcome of storing a result.
enum class StoreStatus {
  kNew,
  kExisting,  ///< an equal result exists
  kConflict,  ///< another result with the same id exists; nothing is changed
};

/// Outcome of an acknowledgment: done, acknowledged earlier, or unknown finding.
enum class AcknowledgeStatus { kDone, kAlready, kUnknown };

/// Store of results, one per id, durable once `add` returns. Updates the tables of the page (views.h) in the same
/// transaction.
class Store {
 public:
  /// Opens the store, or creates it. Throws InputError when it cannot be opened, or another process has it open.
  explicit Store(const std::filesystem::path& folder);

  /// Stores all results in one transaction; on an exception none is stored.
  std::vector<StoreStatus> add(const std::vector<Result>& results, std::int64_t received_ms);

  /// Acknowledges a warning or alarm with the user's name and note.
  AcknowledgeStatus acknowledge(std::int64_t finding, const std::string& who, const std::string& note,
                                std::int64_t now_ms);

  /// Database for the queries of queries.h.
  Database& database() { return database_; }

 private:
  StoreStatus add_one(const Result& result, std::int64_t received_ms, std::int64_t revision);
  std::int64_t next_revision();

  FolderLock lock_;
  Database database_;
};

}  // namespace patrol::monitor
