#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/named_table.h"
#include "core/time.h"

/// Results of the tunnel inspection, for the log, the report and the monitoring server.
namespace patrol {

/// Severity of a finding. A notice is recorded only; a warning switches the light on; an alarm also switches the siren
/// on.
enum class WarningLevel : std::uint8_t { kNone, kNotice, kWarning, kAlarm };

inline constexpr std::array kWarningLevels = std::to_array<NamedValue<WarningLevel>>({
    {WarningLevel::kNone, "none", "Nothing to report"},
    {WarningLevel::kNotice, "notice", "Written to the log"},
    {WarningLevel::kWarning, "warning", "Switches the warning light on"},
    {WarningLevel::kAlarm, "alarm", "Switches the warning light and the siren on"},
});
static_assert(is_in_order(kWarningLevels));

constexpr std::string_view name_of(WarningLevel level) { return row_of(kWarningLevels, level).name; }

/// Radial displacement of one angular cell of a ring, relative to the reference scan. Inward is positive.
struct LiningCell {
  int ring = 0;
  double clock_deg = 0.0;  ///< clock position of the cell center (core/tunnel_lining.h)
  double inward_m = 0.0;
  double std_m = 0.0;  ///< standard deviation of `inward_m`, including the registration
  int points = 0;      ///< number of points of the new scan in the cell
};

/// Change in length of a chord between two points of a ring, the convergence of tunnel surveying. Lengthening is
/// positive.
struct ConvergenceLine {
  int ring = 0;
  std::string name;  ///< clock positions of the ends, e.g. "9-3": from nine to three o'clock
  double change_m = 0.0;
  double std_m = 0.0;
};

/// Ring whose displacement exceeds the notice threshold.
struct RingFinding {
  int ring = 0;
  double clock_deg = 0.0;  ///< clock position of the maximum displacement
  double inward_m = 0.0;   ///< maximum displacement, inward positive
  double std_m = 0.0;
  WarningLevel level = WarningLevel::kNotice;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< point of maximum displacement, m
};

/// Lining deformation around a station, from one panoramic scan and the reference scan of the station.
struct LiningResult {
  Time stamp{};
  std::string station;
  Pose2 T_map_body;                        ///< pose from the registration; the estimate of the robot if that failed
  bool is_registered = false;              ///< false: the registration failed; cells, lines and findings are empty
  double registration_rms_m = 0.0;         ///< root mean square residual of the inliers of the registration
  double registration_inlier_ratio = 0.0;  ///< inlier ratio of the registration
  double correction_m = 0.0;               ///< distance between the registered pose and the robot's own estimate
  std::vector<LiningCell> cells;
  std::vector<ConvergenceLine> lines;
  std::vector<RingFinding> findings;
};

/// Water ahead of the tunnel face, from the TEM soundings of one station.
struct WaterResult {
  Time stamp{};
  std::string station;
  Pose2 T_map_body;
  int soundings = 0;
  double antenna_error_deg = 0.0;  ///< root mean square error of the antenna angles: encoder reading minus command
  double rock_spm = 0.0;           ///< electrical conductivity of the rock, S/m
  double evidence = 0.0;           ///< natural logarithm of the Bayes factor of a conductive body against rock alone
  bool is_found = false;           ///< the fields below are valid only if true; intervals are 95 % credible intervals
  WarningLevel level = WarningLevel::kNone;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();          ///< center of the body, m
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< covariance of `p_map`
  double distance_m = 0.0;                                  ///< distance from the antenna to the center of the body
  double distance_low_m = 0.0, distance_high_m = 0.0;
  double azimuth_deg = 0.0;    ///< azimuth from the antenna, positive to the left of the robot's x axis
  double elevation_deg = 0.0;  ///< elevation, positive upward
  double radius_m = 0.0;       ///< radius of the equivalent sphere
  double radius_low_m = 0.0, radius_high_m = 0.0;
};

}  // namespace patrol
