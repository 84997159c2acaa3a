#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/robot_description.h"
#include "inspect/water/water_inversion.h"
#include "inspect/water/water_sounding.h"
#include "stack/instruments/instrument.h"

namespace patrol::stack {

/// Transient-electromagnetic water detector: takes soundings at a series of antenna poses and estimates a body of water
/// ahead.
///
/// Events: water_notice, water_warning, water_alarm (value: distance, m), water_not_found.
class WaterInstrument final : public Instrument {
 public:
  WaterInstrument(const inspect::WaterSettings& settings, AntennaGeometry antenna, std::uint64_t seed);

  InstrumentKind kind() const override { return InstrumentKind::kWater; }
  void add(const SensorMessage& message, const StationPoseLookup& station_pose_at) override;
  void begin(const InspectionOrder& order, Time now) override;
  InspectionProgress step(const InspectionContext& context) override;
  void serialize_state(StateArchive& archive) override;

 private:
  WaterResult estimate(const InspectionContext& context) const;
  void report(const InspectionContext& context, const WaterResult& result) const;

  inspect::WaterSettings settings_;
  AntennaGeometry geometry_;
  inspect::WaterInversion inversion_;
  std::uint64_t seed_;
  std::string station_;
  std::optional<inspect::WaterSounding> sounding_;
  std::optional<AntennaState> antenna_;
  std::optional<TemSounding> new_sounding_;
};

}  // namespace patrol::stack
