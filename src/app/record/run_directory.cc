#include "app/record/run_directory.h"

#include <fmt/format.h>

#include "app/common/output_directory.h"
#include "app/record/outbox.h"
#include "core/error.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::app {
namespace {

const OutputKind kRun = {.name = "run",
                         .marker_text = "Incomplete run: these files are not a result.",
                         .outputs = {"scenario.yaml",    "log.mcap",     "registration.json", "metrics.json",
                                     "junit.xml",        "estimate.tum", "truth.tum",         "odometry.tum",
                                     "map.yaml",         "map.pgm",      "truth_map.yaml",    "truth_map.pgm",
                                     "report.html",      "replay.mp4",   "nav.json",          "teleop.csv",
                                     "scans/scans.json", "scans/*.ply",  "map_errors.pgm",    "localizability.csv",
                                     "still_*.png",      "outbox.jsonl", "outbox.sent",       "outbox.refused.jsonl",
                                     "stack.log",        "branch.json",  "snapshots/*.snap",  "*.part"},
                         .required_file = "scenario.yaml",
                         .preserved = {}};

}  // namespace

bool RunDirectory::is_complete() const {
  return std::filesystem::exists(metrics()) && !std::filesystem::exists(incomplete_marker(root));
}

RunDirectory begin_run_directory(const std::filesystem::path& root) {
  if (const std::size_t num_pending = num_pending_results(root); num_pending > 0) {
    throw InputError(
        fmt::format("{}: contains {} undelivered results of an earlier run; upload them with 'patrol upload' or choose "
                    "another --out directory",
                    root.string(), num_pending));
  }
  return {.root = root, .lock = std::make_shared<const OutputLock>(begin_output(root, kRun))};
}

std::filesystem::path log_of(const std::filesystem::path& run_or_log) {
  const RunDirectory run{run_or_log};
  return std::filesystem::is_directory(run_or_log) && std::filesystem::exists(run.log()) ? run.log() : run_or_log;
}

RunDirectory open_run_directory(const std::filesystem::path& root) {
  RunDirectory directory{root};
  if (!std::filesystem::exists(directory.log())) {
    throw InputError(fmt::format("{}: not a run directory: log.mcap not found", root.string()));
  }
  return directory;
}

void require_whole_log(const RunDirectory& run, const std::string& consequence) {
  if (!io::McapReader(run.log()).is_complete())
    throw InputError(fmt::format("{}: is incomplete; {}", run.log().string(), consequence));
}

void require_complete(const RunDirectory& run, const std::string& consequence) {
  if (std::filesystem::exists(incomplete_marker(run.root)))
    throw InputError(fmt::format("{}: incomplete run; {}", run.root.string(), consequence));
  require_whole_log(run, consequence);
}

}  // namespace patrol::app
