#pragma once

#include <optional>
#include <vector>

#include "core/route.h"
#include "score/arrival_score.h"
#include "score/calibration_score.h"
#include "score/driven_clearance.h"
#include "score/goal_error.h"
#include "score/inspection_score.h"
#include "score/lining_score.h"
#include "score/localizability_track.h"
#include "score/map_error.h"
#include "score/pose/localization_score.h"
#include "score/pose/pose_nees.h"
#include "score/pose/site_score.h"
#include "score/pose/trajectory_error.h"
#include "score/run/course_score.h"
#include "score/run_record.h"
#include "score/station_error.h"
#include "score/visibility.h"
#include "score/water_score.h"

/// Evaluation of a run: everything that metrics.json says of it but `performance`, which only the run itself knows.
namespace patrol::score {

/// Ground truth and survey that a run is evaluated against.
struct RunReferences {
  ReferenceMap map;                          ///< in world
  double map_agreement = 0.0;                ///< ratio of the reference's cells that an independent rendering confirms
  Pose2 T_site_start;                        ///< surveyed start; site is world
  std::optional<Pose2> T_world_map;          ///< pose of a given map's frame; none for a map that the run makes
  Route route;                               ///< survey, in world
  std::vector<SavedGoal> goals;              ///< given goals, in map
  std::vector<Eigen::Vector2d> footprint_m;  ///< outline of the robot
  std::vector<LeakGroundTruth> leaks;
  std::optional<LiningGroundTruth> lining;
  std::vector<WaterGroundTruth> waters;
  std::optional<Eigen::Vector3d> p_body_antenna;  ///< mount of the sounding antenna, m
  std::vector<Time> kidnaps;
  CalibrationReferences calibration;
  LocalizabilityOracle localizability;
};

struct MissionScore {
  bool is_completed = false;           ///< reported, and not contradicted by the true path
  bool is_reported_completed = false;  ///< reported by the robot
  std::size_t num_false_arrivals = 0;  ///< reported arrivals that the true position contradicts (arrival_score.h)
  bool has_fallen = false;
  std::size_t num_collisions = 0;
  std::size_t num_sensor_faults = 0;  ///< faults that the sensor monitor detected
  double duration_s = 0.0;
  double distance_m = 0.0;
};

struct NavigationScore {
  std::size_t num_paths = 0;
  std::size_t num_detours = 0;
  std::size_t num_recoveries = 0;
  DrivenClearance clearance;
};

/// Monte Carlo localization on a known map.
struct KnownMapScore {
  LocalizationScore localization;
  std::vector<RelocalizationScore> kidnaps;
};

/// Scores that need an estimate.
struct EstimateScore {
  /// True pose of the map's frame: of the given map, or by fit_map_to_reference, or by fit_map_frame without a map.
  Pose2 T_world_map;
  TrajectoryError pose;        ///< on the common clock (live_trajectory.h), as are `odometry` and `range_pose`
  SiteScore site;              ///< pose and registration in the survey frame
  double pose_coverage = 0.0;  ///< fraction of the run within 0.2 s of a timely pose (live_trajectory.h)
  PoseNees nees;
  std::optional<AlignedError> aligned_pose;  ///< none when no fit is possible, e.g. of an estimate that never moves
  std::optional<TrajectoryError> odometry;   ///< error of odometry; none without odometry in the log
  std::optional<MapError> map;  ///< none without a map in the log or without surfaces that the robot could see
  double map_agreement = 0.0;
  std::vector<TrackedLocalizability> localizability;
  NavigationScore navigation;
  std::vector<StationError> stations;
  std::vector<ScoredParameter> calibration;  ///< parameters of an as-built robot; empty without an estimate
  std::vector<GoalError> goals;
  std::optional<GoalError> docking;           ///< error of docking; none without a dock in the survey
  std::optional<TrajectoryError> range_pose;  ///< error of the estimate by odometry and UWB ranges; none without it
  std::optional<KnownMapScore> known_map;     ///< scores on a known map; none without a confidence in the log
  InspectionScore inspection;
  std::optional<LiningScore> lining;  ///< score of the lining; none without a result in the log
  std::optional<WaterScore> water;    ///< score of the water detection; none without a result in the log
};

struct RunScore {
  MissionScore mission;
  std::optional<CourseScore> course;      ///< none: the scenario is not an obstacle course
  std::optional<EstimateScore> estimate;  ///< none: the stack published no estimate
};

/// `goals`: stations, given goals and dock of the mission.
MissionScore mission_score(const RunRecord& record, const std::vector<MissionGoal>& goals);

/// Precondition: `record.has_estimate()`. Throws InputError when estimate and ground truth have no instant in common.
EstimateScore estimate_score(const RunRecord& record, const RunReferences& references);

}  // namespace patrol::score
