#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/process_pool.h"
#include "app/batch/result_store.h"
#include "core/named_table.h"

namespace patrol::app {

/// One run that a sweep or a test wants done.
struct BatchRun {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string address;  ///< where its result goes
  std::string label;    ///< for people
};

/// Whose run directories stay, as `runs/ADDRESS/`, once they are scored.
enum class KeepRuns { kNone, kFailed, kAll };

inline constexpr std::array kKeepRuns = std::to_array<NamedValue<KeepRuns>>({
    {KeepRuns::kNone, "none", "No run directory is kept"},
    {KeepRuns::kFailed, "failed", "Directories of runs that did not meet their expectations are kept"},
    {KeepRuns::kAll, "all", "Every run directory is kept"},
});
static_assert(is_in_order(kKeepRuns));

struct BatchSettings {
  ProcessPoolSettings pool;
  KeepRuns keep = KeepRuns::kNone;
};

/// Runs them, stores a verdict on each whatever becomes of it, and tells how far it is. A run that is killed from outside is tried once
/// more. False when interrupted: what has ended is stored.
bool run_batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root);

}  // namespace patrol::app
