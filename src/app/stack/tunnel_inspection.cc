#include "app/stack/tunnel_inspection.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

using inspect::InspectionFeedback;
using inspect::TourMode;

/// "3:30" of 105 degrees, as one reads a clock.
std::string clock_text(double clock_deg) {
  const int half_hours = static_cast<int>(std::lround(clock_deg / 15.0)) % 24;
  const int hour = half_hours / 2 == 0 ? 12 : half_hours / 2;
  return fmt::format("{}:{:02}", hour, half_hours % 2 * 30);
}

bool asks_for(const std::vector<MarkedGoal>& goals, GoalType type) {
  return std::any_of(goals.begin(), goals.end(), [&](const MarkedGoal& goal) { return goal.type == type; });
}

}  // namespace

Pose3 StandingPlace::T_map_scanner(const Pose3& T_body_scanner) const {
  const Pose3 T_map_tilted = to_spatial(T_map_body) * T_level_body * T_body_scanner;
  return {T_map_tilted.position, quaternion_from_yaw(yaw_of(T_map_tilted.rotation))};
}

TunnelInspection::TunnelInspection(const InspectionSettings& settings, const RobotDescription& robot, const std::optional<TunnelLining>& lining_in_map,
                                   LiningReferences references, const std::vector<MarkedGoal>& goals, std::uint64_t seed)
    : settings_(settings),
      references_(std::move(references)),
      antenna_geometry_(robot.antenna),
      inversion_(settings.water),
      seed_(seed) {
  validate(settings, "inspection");
  if (asks_for(goals, GoalType::kScan) && !lining_in_map) throw InputError("tour: a goal is of type D, but the site's survey has no lining");
  if (asks_for(goals, GoalType::kScan)) robot.T_body("scanner");
  if (!lining_in_map || !robot.T_body_sensor.contains("scanner")) return;
  T_body_scanner_ = robot.T_body("scanner");
  lining_.emplace(settings.lining, *lining_in_map, T_body_scanner_);
}

void TunnelInspection::add(const PanoramicScan& scan, const StandingPlace& place) {
  if (mode_ == TourMode::kScan) new_scan_ = {scan, place};
}

InspectionFeedback TunnelInspection::step(Time now, TourMode mode, const std::string& station, const StandingPlace& place) {
  place_ = place;
  if (siren_until_ && now >= *siren_until_) {
    siren_until_.reset();
    messages_.emplace_back(WarningCommand{now, warned_ >= WarningLevel::kWarning, false});
  }
  const bool is_new = std::exchange(mode_, mode) != mode;
  station_ = station;
  if (is_new) begin(now);
  if (mode == TourMode::kScan) return scan(now);
  if (mode == TourMode::kSound) return sound(now);
  return InspectionFeedback::kUnderWay;
}

void TunnelInspection::begin(Time now) {
  began_ = now;
  new_scan_.reset();
  new_sounding_.reset();
  sounding_.reset();
  has_asked_ = false;
  if (mode_ == TourMode::kSound && antenna_geometry_) sounding_.emplace(settings_.water.sounding, *antenna_geometry_, now);
}

InspectionFeedback TunnelInspection::scan(Time now) {
  if (!lining_) return InspectionFeedback::kFailed;
  if (!has_asked_ && now - began_ >= from_seconds(settings_.scan_settle_s)) {
    has_asked_ = true;
    messages_.emplace_back(ScanCommand{now});
  }
  if (now - began_ > from_seconds(settings_.scan_patience_s)) return InspectionFeedback::kFailed;
  if (!new_scan_) return InspectionFeedback::kUnderWay;
  const auto [scan, place] = *std::exchange(new_scan_, std::nullopt);
  say_event(now, EventKind::kScanTaken, station_, fmt::format("Panoramic scan of {} points.", scan.points.size()), static_cast<double>(scan.points.size()),
            place_.T_map_body.position());
  const auto reference = references_.find(station_);
  if (reference == references_.end()) {
    references_.emplace(station_, inspect::make_reference(scan, place.T_map_scanner(T_body_scanner_)));
    say_event(now, EventKind::kReferenceTaken, station_, "The first scan of this place: later ones are compared with it.", 0.0, place_.T_map_body.position());
    return InspectionFeedback::kDone;
  }
  LiningResult result = lining_->inspect(now, station_, scan, reference->second, place.T_map_scanner(T_body_scanner_));
  report(now, result);
  const bool is_registered = result.is_registered;
  messages_.emplace_back(std::move(result));
  return is_registered ? InspectionFeedback::kDone : InspectionFeedback::kFailed;
}

InspectionFeedback TunnelInspection::sound(Time now) {
  if (!sounding_) return InspectionFeedback::kFailed;
  const auto order = sounding_->step(now, antenna_, std::exchange(new_sounding_, std::nullopt));
  if (order) std::visit([&](const auto& command) { messages_.emplace_back(command); }, *order);
  if (!sounding_->is_over()) return InspectionFeedback::kUnderWay;
  if (!sounding_->is_stowed() || sounding_->soundings().empty()) return InspectionFeedback::kFailed;
  AntennaGeometry antenna = *antenna_geometry_;  // as tilted as the robot stands
  antenna.T_body_mount = Pose3{Eigen::Vector3d::Zero(), place_.T_level_body.rotation} * antenna.T_body_mount;
  WaterResult result = inversion_.invert(sounding_->soundings(), antenna, place_.T_map_body, sounding_->antenna_error_deg(), seed_);
  result.stamp = now;
  result.station = station_;
  report(now, result);
  messages_.emplace_back(std::move(result));
  return sounding_->num_left_out() == 0 ? InspectionFeedback::kDone : InspectionFeedback::kFailed;
}

void TunnelInspection::report(Time now, const LiningResult& result) {
  if (!result.is_registered) return;
  for (const RingFinding& finding : result.findings) {
    say_event(now, lining_event(finding.level), fmt::format("ring_{}", finding.ring),
              fmt::format("Ring {} has moved inwards by {:.1f} ± {:.1f} mm at {} o'clock.", finding.ring, 1e3 * finding.inward_m, 1e3 * finding.std_m,
                          clock_text(finding.clock_deg)),
              finding.inward_m, finding.p_map.head<2>());
    warn(now, finding.level);
  }
  if (result.findings.empty()) say_event(now, EventKind::kLiningUnchanged, station_, "No ring has moved.", 0.0, place_.T_map_body.position());
}

void TunnelInspection::report(Time now, const WaterResult& result) {
  if (!result.is_found) {
    say_event(now, EventKind::kWaterNotFound, station_, fmt::format("No water ahead: {} soundings.", result.soundings), 0.0, place_.T_map_body.position());
    return;
  }
  say_event(now, water_event(result.level), station_,
            fmt::format("Water ahead, {:.1f} m from the antenna ({:.1f} to {:.1f} m), {:.0f} degrees to the {}: a body {:.1f} m across ({:.1f} to {:.1f} m).",
                        result.distance_m, result.distance_low_m, result.distance_high_m, std::abs(result.azimuth_deg),
                        result.azimuth_deg >= 0.0 ? "left" : "right", 2.0 * result.radius_m, 2.0 * result.radius_low_m, 2.0 * result.radius_high_m),
            result.distance_m, result.p_map.head<2>());
  warn(now, result.level);
}

void TunnelInspection::warn(Time now, WarningLevel level) {
  if (level < WarningLevel::kWarning) return;
  const bool is_alarm = level == WarningLevel::kAlarm;
  if (is_alarm) siren_until_ = now + from_seconds(settings_.siren_s);
  if (level <= warned_ && !is_alarm) return;
  warned_ = std::max(warned_, level);
  messages_.emplace_back(WarningCommand{now, true, siren_until_.has_value()});
}

void TunnelInspection::say_event(Time now, EventKind kind, const std::string& subject, const std::string& text, double value,
                                 const Eigen::Vector2d& p_map) {
  messages_.emplace_back(Event{.stamp = now, .kind = kind, .subject = subject, .text = text, .value = value, .T_map_body = place_.T_map_body, .p_map_target = p_map});
}

}  // namespace patrol::app
