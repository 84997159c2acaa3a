#pragma once

#include <filesystem>
#include <optional>

#include "score/run_record.h"

namespace patrol::app {

using score::RunRecord;

/// Reads the record from a run's log. Throws InputError if the log is damaged or ends before the first ground truth.
RunRecord read_run_record(const std::filesystem::path& log_mcap);

/// Returns the pose of map in world for views of a run: that of a given map, or else of the last registration to the
/// survey. Without one, the trajectories are aligned at the start; without estimates, it is the first true pose.
Pose2 pose_of_map(const RunRecord& record, const std::optional<Pose2>& T_world_given_map);

}  // namespace patrol::app
