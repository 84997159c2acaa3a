#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/common/output_directory.h"

namespace patrol::app {

/// Files of a run directory (README, "The run directory").
struct RunDirectory {
  std::filesystem::path root;
  std::shared_ptr<const OutputLock> lock = nullptr;  ///< lock while the run is being written

  std::filesystem::path scenario() const { return root / "scenario.yaml"; }
  std::filesystem::path log() const { return root / "log.mcap"; }
  std::filesystem::path stack_output() const { return root / "stack.log"; }  ///< output of a stack in another process
  std::filesystem::path nav() const { return root / "nav.json"; }
  std::filesystem::path registration() const { return root / "registration.json"; }
  std::filesystem::path teleop() const { return root / "teleop.csv"; }
  std::filesystem::path scans() const { return root / "scans"; }
  std::filesystem::path metrics() const { return root / "metrics.json"; }
  std::filesystem::path junit() const { return root / "junit.xml"; }
  std::filesystem::path estimate() const { return root / "estimate.tum"; }
  std::filesystem::path truth() const { return root / "truth.tum"; }
  std::filesystem::path odometry() const { return root / "odometry.tum"; }
  std::filesystem::path map() const { return root / "map.yaml"; }
  std::filesystem::path map_errors() const { return root / "map_errors.pgm"; }
  std::filesystem::path localizability() const { return root / "localizability.csv"; }
  std::filesystem::path truth_map() const { return root / "truth_map.yaml"; }

  std::filesystem::path snapshots() const { return root / "snapshots"; }
  std::filesystem::path branch() const { return root / "branch.json"; }  ///< origin of a branch

  bool is_complete() const;
};

/// Beginning of the comment of a scenario whose stack was fed with the log of a run.
inline constexpr const char* kFedComment = "stack fed with ";

/// Creates the directory and marks it incomplete (output_directory.h). Removes the files of an earlier run. Throws
/// InputError if results of that run have not been uploaded.
RunDirectory begin_run_directory(const std::filesystem::path& root);

/// Returns the log of a run directory; another path as it is.
std::filesystem::path log_of(const std::filesystem::path& run_or_log);

/// Opens the directory of an existing run. Throws InputError if it contains no log.
RunDirectory open_run_directory(const std::filesystem::path& root);

/// Throws InputError if the log of a run is truncated. `consequence`: end of the message, such as "cannot be scored".
void require_whole_log(const RunDirectory& run, const std::string& consequence);

/// Throws InputError if a run was cut off or its log is truncated. `consequence`: as for `require_whole_log`.
void require_complete(const RunDirectory& run, const std::string& consequence);

}  // namespace patrol::app
