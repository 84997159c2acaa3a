#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/stack/robot_stack.h"
#include "core/route.h"
#include "inspect/lining/lining_inspection.h"
#include "inspect/tour.h"
#include "inspect/water/water_inversion.h"
#include "inspect/water/water_sounding.h"

namespace patrol::app {

/// The first scans, by station.
using LiningReferences = std::map<std::string, inspect::LiningReference>;

/// Where the robot stood at an instant.
struct StandingPlace {
  Pose3 T_level_body;  ///< tilt, and height above the ground
  Pose2 T_map_body;

  /// Of `scanner_level` in map.
  Pose3 T_map_scanner(const Pose3& T_body_scanner) const;
};

/// The instruments' work at the places of a round: what is asked of scanner, antenna, light and siren, what comes of it, and what
/// is said of that.
///
/// Events: scan_taken, reference_taken (there was no earlier scan of the station), lining_notice, lining_warning, lining_alarm (subject
/// "ring_31", value m inwards), lining_unmoved, water_warning, water_alarm (value m to it), no_water.
class TunnelInspection {
 public:
  /// Throws InputError when a goal asks for an instrument that the robot has not got, or for a lining that the survey does not know.
  TunnelInspection(const InspectionSettings& settings, const RobotDescription& robot, const std::optional<TunnelLining>& lining_in_map,
                   LiningReferences references, const std::vector<MarkedGoal>& goals, std::uint64_t seed);

  void add(const PanoramicScan& scan, const StandingPlace& place);
  void add(const AntennaState& state) { antenna_ = state; }
  void add(const TemSounding& sounding) { new_sounding_ = sounding; }

  /// Once a control period: the work of this mode at this station; what was begun in another is broken off.
  inspect::InspectionFeedback step(Time now, inspect::TourMode mode, const std::string& station, const StandingPlace& place);

  /// What was said since the last call, in order.
  std::vector<StackMessage> take_messages() { return std::exchange(messages_, {}); }

 private:
  void begin(Time now);
  inspect::InspectionFeedback scan(Time now);
  inspect::InspectionFeedback sound(Time now);
  void report(Time now, const LiningResult& result);
  void report(Time now, const WaterResult& result);
  void warn(Time now, WarningLevel level);
  void say_event(Time now, EventKind kind, const std::string& subject, const std::string& text, double value,
                 const Eigen::Vector2d& p_map);

  InspectionSettings settings_;
  Pose3 T_body_scanner_;
  std::optional<inspect::LiningInspection> lining_;
  LiningReferences references_;
  std::optional<AntennaGeometry> antenna_geometry_;
  inspect::WaterInversion inversion_;
  std::uint64_t seed_;

  inspect::TourMode mode_ = inspect::TourMode::kStand;
  std::string station_;
  Time began_{};
  StandingPlace place_;
  bool has_asked_ = false;                          ///< for the scan
  std::optional<inspect::WaterSounding> sounding_;  ///< with kSound
  std::optional<std::pair<PanoramicScan, StandingPlace>> new_scan_;
  std::optional<AntennaState> antenna_;
  std::optional<TemSounding> new_sounding_;
  WarningLevel warned_ = WarningLevel::kNone;
  std::optional<Time> siren_until_;
  std::vector<StackMessage> messages_;
};

}  // namespace patrol::app
