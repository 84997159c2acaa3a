#pragma once

#include <vector>

#include "io/json/metrics_json.h"
#include "score/calibration_score.h"
#include "score/driven_clearance.h"
#include "score/goal_error.h"
#include "score/inspection_score.h"
#include "score/lining_score.h"
#include "score/localizability.h"
#include "score/map_error.h"
#include "score/pose/localization_score.h"
#include "score/pose/pose_nees.h"
#include "score/pose/trajectory_error.h"
#include "score/run/run_score.h"
#include "score/station_error.h"
#include "score/water_score.h"

namespace patrol::app {

/// Scores in the form of metrics.json: every metric by its name, null without a value.
io::Metrics to_json(const score::TrajectoryError& error);
io::Metrics to_json(const score::AlignedError& error);
io::Metrics to_json(const score::PoseNees& score);
io::Metrics to_json(const score::MapError& error);
io::Metrics to_json(const score::DrivenClearance& clearance);
io::Metrics to_json(const std::vector<score::StationError>& errors);
io::Metrics to_json(const score::InspectionScore& score);
io::Metrics to_json(const score::GoalError& error);
io::Metrics to_json(const score::LocalizationScore& score);
io::Metrics to_json(const score::LocalizabilityScore& score);
io::Metrics to_json(const score::RelocalizationScore& score);
io::Metrics to_json(const std::vector<score::ScoredParameter>& calibration);
io::Metrics to_json(const score::LiningScore& score);
io::Metrics to_json(const score::WaterScore& score);

/// metrics.json without `performance`.
io::Metrics to_json(const score::RunScore& run);

}  // namespace patrol::app
