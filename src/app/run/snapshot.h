#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "core/time.h"

namespace patrol::app {

/// State of a run at an instant: simulator, built-in stack and the loop between them.
struct RunState {
  Time time{};
  std::string bytes;  ///< state written by StateArchive
};

/// Identity of the runs whose states are exchangeable: program, scenario and the files that it names.
std::string content_hash(const Scenario& scenario, const std::filesystem::path& data_root);

/// Writes snapshots into a folder: TIME.snap, the time in seconds.
class SnapshotFolder {
 public:
  /// `content`: content hash of the run. `name`: of its scenario.
  SnapshotFolder(std::filesystem::path folder, std::string content, std::string name);

  /// Writes a file under another name and renames it.
  void save(const RunState& state) const;

 private:
  std::filesystem::path folder_;
  std::string content_;
  std::string name_;
};

/// Returns the instants of the snapshots of a folder, in ascending order; none without the folder.
std::vector<Time> snapshot_times(const std::filesystem::path& folder);

/// Returns the newest snapshot of a folder at or before a time; none if there is none. Throws InputError, naming the
/// file, if it is damaged, or if its run had another content hash.
std::optional<RunState> load_snapshot(const std::filesystem::path& folder, Time at, const std::string& content);

/// Throws InputError, naming the first one, if settings differ that shape the state of a run, or events before `at`.
/// Settings that the simulator and the stack read while they run may differ.
void check_branch_settings(const Scenario& parent, const Scenario& branch, Time at);

/// Paths of the settings that a branch may change; those that end in a point are sections.
const std::vector<std::string>& branch_settings();

}  // namespace patrol::app
