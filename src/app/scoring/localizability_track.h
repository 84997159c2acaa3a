#pragma once

#include <filesystem>
#include <vector>

#include "app/run/run_record.h"
#include "app/scoring/localizability_oracle.h"

namespace patrol::app {

/// The oracle beside the stack's own word, where the robot truly was.
struct TrackedLocalizability {
  Time stamp{};
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
  score::LocalizabilitySample sample;
};

/// At most two a second, at instants of the stack's estimates.
std::vector<TrackedLocalizability> track_localizability(const RunRecord& record, const Pose2& T_world_map, const LocalizabilityOracle& oracle);

score::LocalizabilityScore score_of(const std::vector<TrackedLocalizability>& track);

/// One row each: s, m, degrees in world.
void save_localizability(const std::filesystem::path& file_csv, const std::vector<TrackedLocalizability>& track);

}  // namespace patrol::app
