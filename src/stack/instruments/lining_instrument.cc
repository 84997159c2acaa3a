#include "stack/instruments/lining_instrument.h"

#include <cmath>

#include <fmt/format.h>

namespace patrol::stack {
namespace {

/// Returns the clock position, e.g. "3:30" for 105 degrees.
std::string clock_text(double clock_deg) {
  const int half_hours = static_cast<int>(std::lround(clock_deg / 15.0)) % 24;
  const int hour = half_hours / 2 == 0 ? 12 : half_hours / 2;
  return fmt::format("{}:{:02}", hour, half_hours % 2 * 30);
}

}  // namespace

LiningInstrument::LiningInstrument(const InspectionSettings& settings, const TunnelLining& lining_in_map,
                                   const Pose3& T_body_scanner, LiningReferences references)
    : settings_(settings),
      T_body_scanner_(T_body_scanner),
      inspection_(settings.lining, lining_in_map, T_body_scanner),
      references_(std::move(references)) {}

void LiningInstrument::add(const SensorMessage& message, const StationPoseLookup& station_pose_at) {
  const auto* scan = std::get_if<PanoramicScan>(&message);
  if (!scan || !is_active_) return;
  if (const auto station_pose = station_pose_at(scan->stamp)) new_scan_ = {*scan, *station_pose};
}

void LiningInstrument::begin(const InspectionOrder& order, Time now) {
  station_ = order.station;
  order_start_ = now;
  is_active_ = true;
  has_requested_scan_ = false;
  new_scan_.reset();
}

InspectionProgress LiningInstrument::step(const InspectionContext& context) {
  const Time now = context.now;
  if (!has_requested_scan_ && now - order_start_ >= from_seconds(settings_.scan_settling_time_s)) {
    has_requested_scan_ = true;
    context.output.publish(ScanCommand{now});
  }
  if (now - order_start_ > from_seconds(settings_.scan_timeout_s)) return {.feedback = InspectionFeedback::kFailed};
  if (!new_scan_) return {};
  const auto [scan, station_pose] = *std::exchange(new_scan_, std::nullopt);
  return {.feedback = evaluate(context, scan, station_pose)};
}

InspectionFeedback LiningInstrument::evaluate(const InspectionContext& context, const PanoramicScan& scan,
                                              const StationPose& station_pose) {
  const Eigen::Vector2d p_map = context.station_pose.T_map_body.position();
  const auto num_points = scan.points.size();
  context.publish_event(EventKind::kScanTaken, station_, fmt::format("Panoramic scan of {} points.", num_points),
                        static_cast<double>(num_points), p_map);
  const auto reference = references_.find(station_);
  if (reference == references_.end()) {
    references_.emplace(station_, inspect::make_reference(scan, station_pose.T_map_scanner(T_body_scanner_)));
    context.publish_event(EventKind::kReferenceTaken, station_, "First scan of the station: reference for later scans.",
                          0.0, p_map);
    return InspectionFeedback::kDone;
  }
  LiningResult result =
      inspection_.inspect(context.now, station_, scan, reference->second, station_pose.T_map_scanner(T_body_scanner_));
  report(context, result);
  const bool is_registered = result.is_registered;
  context.output.publish(std::move(result));
  return is_registered ? InspectionFeedback::kDone : InspectionFeedback::kFailed;
}

void LiningInstrument::report(const InspectionContext& context, const LiningResult& result) const {
  if (!result.is_registered) return;
  for (const RingFinding& finding : result.findings) {
    context.publish_event(lining_event(finding.level), fmt::format("ring_{}", finding.ring),
                          fmt::format("Ring {} has moved inward by {:.1f} ± {:.1f} mm at {} o'clock.", finding.ring,
                                      1e3 * finding.inward_m, 1e3 * finding.std_m, clock_text(finding.clock_deg)),
                          finding.inward_m, finding.p_map.head<2>());
    context.light.warn(context.now, finding.level, context.output);
  }
  if (result.findings.empty())
    context.publish_event(EventKind::kLiningUnchanged, station_, "No ring has moved.", 0.0,
                          context.station_pose.T_map_body.position());
}

}  // namespace patrol::stack
