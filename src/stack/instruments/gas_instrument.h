#pragma once

#include <utility>

#include "core/robot_description.h"
#include "inspect/gas_measurement.h"
#include "stack/instruments/instrument.h"

namespace patrol::stack {

/// Parameters of a methane measurement at a station (settings: gas_mission_settings.h).
struct GasRules {
  double settling_time_s = 0.5;
  double measurement_duration_s = 3.0;
  double measurement_timeout_s = 8.0;
  int min_readings = 10;
  double alarm_column_ppm_m = 200.0;
};

/// Open-path methane meter: averages the column readings while the robot stands, and raises the alarm if the mean
/// exceeds the threshold by two standard errors.
///
/// Events: gas_measured (value: column, ppm m), gas_alarm (value: column; target: the point of the beam nearest to the
/// inspected object).
class GasInstrument final : public Instrument {
 public:
  /// `T_body_gas`: pose of the methane meter, whose beam is along x.
  GasInstrument(const GasRules& rules, Pose3 T_body_gas) : rules_(rules), T_body_gas_(std::move(T_body_gas)) {}

  InstrumentKind kind() const override { return InstrumentKind::kGas; }
  void add(const SensorMessage& message, const StationPoseLookup& station_pose_at) override;
  void begin(const InspectionOrder& order, Time now) override;
  InspectionProgress step(const InspectionContext& context) override;
  void serialize_state(StateArchive& archive) override;

 private:
  void report(const InspectionContext& context) const;
  Eigen::Vector2d closest_point_on_beam(const Pose2& T_map_body) const;

  GasRules rules_;
  Pose3 T_body_gas_;
  InspectionOrder order_;
  std::optional<GasReading> newest_;
  inspect::GasMeasurement measurement_;
};

}  // namespace patrol::stack
