#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/frames.h"
#include "core/named_table.h"
#include "core/time.h"

/// What the robot found out about the tunnel: for the log, the report and the monitoring platform.
namespace patrol {

/// How much it matters. A notice is written down; a warning switches the light on, an alarm the siren too.
enum class WarningLevel : std::uint8_t { kNone, kNotice, kWarning, kAlarm };

inline constexpr std::array kWarningLevels = std::to_array<NamedValue<WarningLevel>>({
    {WarningLevel::kNone, "none", "Nothing to report"},
    {WarningLevel::kNotice, "notice", "Written to the log"},
    {WarningLevel::kWarning, "warning", "Switches the warning light on"},
    {WarningLevel::kAlarm, "alarm", "Switches the warning light and the siren on"},
});
static_assert(is_in_order(kWarningLevels));

constexpr std::string_view name_of(WarningLevel level) { return row_of(kWarningLevels, level).name; }

/// A ring's lining in one direction, against the reference scan. Inwards is positive.
struct LiningCell {
  int ring = 0;
  double clock_deg = 0.0;  ///< of its middle (core/tunnel_lining.h)
  double inward_m = 0.0;
  double std_m = 0.0;      ///< of `inward_m`, registration included
  int points = 0;          ///< of the new scan
};

/// A chord of a ring between two marks on its lining, as surveyors measure it: longer is positive.
struct ConvergenceLine {
  int ring = 0;
  std::string name;  ///< e.g. "9-3": from nine to three o'clock
  double change_m = 0.0;
  double std_m = 0.0;
};

/// A ring that has moved by more than the notice's threshold.
struct RingFinding {
  int ring = 0;
  double clock_deg = 0.0;   ///< where it has moved most
  double inward_m = 0.0;    ///< there
  double std_m = 0.0;
  WarningLevel level = WarningLevel::kNotice;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< of that place, m
};

/// The lining about a station, from one panoramic scan and the reference scan of that station.
struct LiningResult {
  Time stamp{};
  std::string station;
  Pose2 T_map_body;                 ///< where the robot stood, as the registration has it
  bool is_registered = false;       ///< otherwise the scans could not be laid on each other, and nothing below is said
  double registration_rms_m = 0.0;  ///< of the points that the registration kept
  double registration_share = 0.0;  ///< of the points that it kept
  double correction_m = 0.0;        ///< by which the registration moved the robot's own estimate
  std::vector<LiningCell> cells;
  std::vector<ConvergenceLine> lines;
  std::vector<RingFinding> findings;
};

/// Water ahead of the face, from the soundings of one station.
struct WaterResult {
  Time stamp{};
  std::string station;
  Pose2 T_map_body;
  int soundings = 0;
  double antenna_error_deg = 0.0;   ///< root mean square of what the mount read against what was asked
  double rock_spm = 0.0;            ///< conductivity of the rock, S/m
  double evidence = 0.0;            ///< natural logarithm of how much better a body explains the soundings than none
  bool is_found = false;            ///< what follows is said only then; intervals hold the truth with 95 %
  WarningLevel level = WarningLevel::kNone;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();          ///< of the body's middle, m
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< of that, in map
  double distance_m = 0.0;          ///< from the antenna to the body's middle
  double distance_low_m = 0.0, distance_high_m = 0.0;
  double azimuth_deg = 0.0;         ///< from the antenna, to the left of the body's x axis
  double elevation_deg = 0.0;       ///< upwards
  double radius_m = 0.0;            ///< of a sphere that does the same
  double radius_low_m = 0.0, radius_high_m = 0.0;
};

}  // namespace patrol
