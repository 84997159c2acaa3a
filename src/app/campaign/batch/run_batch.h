#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign/batch/process_pool.h"
#include "app/campaign/batch/result_store.h"
#include "core/named_table.h"

namespace patrol::app {

/// Run that a sweep or a test requests.
struct BatchRun {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string key;    ///< content hash or name under which the result is stored
  std::string label;  ///< name of the run for display
};

/// Runs whose directories are kept as `runs/KEY/` after scoring.
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

/// Throws InputError if runs at the same time would wait for their stacks at an address, where only one run can wait.
void require_own_stacks(const std::vector<BatchRun>& runs, const BatchSettings& settings);

/// Executes the runs, stores a verdict for each, and shows the progress. A run that is killed from outside is repeated
/// once. Returns false if interrupted; completed runs are stored. Throws OutputError (io/files/output_error.h) at the
/// first run whose output cannot be written: it has no verdict.
bool run_batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root);

}  // namespace patrol::app
