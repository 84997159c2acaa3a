#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/robot_description.h"
#include "inspect/lining/lining_inspection.h"
#include "stack/instruments/inspection_settings.h"
#include "stack/instruments/instrument.h"

namespace patrol::stack {

/// Reference scans, by station.
using LiningReferences = std::map<std::string, inspect::LiningReference>;

/// 3D scanner: takes a panoramic scan of the tunnel lining and compares it with the reference scan of the station.
///
/// Events: scan_taken, reference_taken (no earlier scan of the station), lining_notice, lining_warning, lining_alarm
/// (subject "ring_31", value m inward), lining_unchanged.
class LiningInstrument final : public Instrument {
 public:
  LiningInstrument(const InspectionSettings& settings, const TunnelLining& lining_in_map, const Pose3& T_body_scanner,
                   LiningReferences references);

  InstrumentKind kind() const override { return InstrumentKind::kLining; }
  void add(const SensorMessage& message, const StationPoseLookup& station_pose_at) override;
  void begin(const InspectionOrder& order, Time now) override;
  InspectionProgress step(const InspectionContext& context) override;
  void end() override { is_active_ = false; }
  void serialize_state(StateArchive& archive) override;

 private:
  InspectionFeedback evaluate(const InspectionContext& context, const PanoramicScan& scan,
                              const StationPose& station_pose);
  void report(const InspectionContext& context, const LiningResult& result) const;

  InspectionSettings settings_;
  Pose3 T_body_scanner_;
  inspect::LiningInspection inspection_;
  LiningReferences references_;
  std::string station_;
  Time order_start_{};
  bool is_active_ = false;
  bool has_requested_scan_ = false;  ///< true: the scan has been requested
  std::optional<std::pair<PanoramicScan, StationPose>> new_scan_;
};

}  // namespace patrol::stack
