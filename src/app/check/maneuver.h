#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/check/check_robot.h"
#include "app/check/check_world.h"
#include "app/check/drive_record.h"
#include "app/check/drive_segment.h"
#include "app/check/figure.h"
#include "core/ground_truth.h"

namespace patrol::app {

/// Part of a check drive: a world, velocity commands and the figures of their record.
struct Maneuver {
  std::string name;   ///< key in check.json
  std::string title;  ///< "10 m straight"
  CheckWorld world;
  std::vector<DriveSegment> segments;
  double settle_s = 1.5;    ///< time before the record begins
  double duration_s = 0.0;  ///< simulated time at most, for the progress
  /// Distance ahead of the start at which the robot is rendered, m; none: no picture.
  std::optional<double> picture_ahead_m = std::nullopt;
  std::vector<Figure> (*measure)(const CheckRobot& robot, const Maneuver& maneuver,
                                 const DriveRecord& record) = nullptr;
};

/// Radius of the circle of a robot that does not turn in place, m: 1.2 times its minimum radius.
inline double wide_circle_radius_m(const CheckRobot& robot) { return 1.2 * robot.limits.min_turning_radius_m; }

/// Returns the maneuvers of a robot, in the order of the check.
std::vector<Maneuver> maneuvers_of(const CheckRobot& robot);

/// Scene of a picture.
struct PictureScene {
  std::string world_mjcf;
  SimState state;
  std::string caption;
};

/// Result of a maneuver.
struct ManeuverResult {
  Maneuver maneuver;
  DriveRecord record;
  std::vector<Figure> figures;
  std::vector<std::string> failures;  ///< sentences; empty: passed
  std::optional<PictureScene> picture;

  bool is_passed() const { return failures.empty(); }
};

}  // namespace patrol::app
