#pragma once

#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "inspect/water/water_settings.h"

namespace patrol::inspect {

struct AntennaPose {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// Row by row, to and fro. Throws InputError, naming the setting, for a pose that the mount does not reach.
std::vector<AntennaPose> antenna_poses(const WaterSoundingSettings& settings, const AntennaGeometry& antenna);

/// A sounding and where the coil was, by its servos.
struct AimedSounding {
  AntennaPose pose;
  TemSounding sounding;
};

/// Takes the soundings of one station: turns the antenna, waits until its servos say that it is there, has a sounding made; pose by pose;
/// stows the antenna at the end. The robot stands still meanwhile.
class WaterSounding {
 public:
  WaterSounding(const WaterSoundingSettings& settings, const AntennaGeometry& antenna, Time start);

  /// At any rate above a few hertz, with the newest of each: the next order, if there is one.
  std::optional<InstrumentCommand> step(Time now, const std::optional<AntennaState>& antenna, const std::optional<TemSounding>& sounding);

  bool is_over() const { return phase_ == Phase::kOver; }
  /// Said once it is over: the servos have read the stowed pose. Otherwise the robot should not drive.
  bool is_stowed() const { return is_stowed_; }
  const std::vector<AimedSounding>& soundings() const { return soundings_; }
  int num_poses() const { return static_cast<int>(poses_.size()); }
  int num_left_out() const { return left_out_; }
  /// Root mean square of the angle between the axes asked for and read, over the soundings.
  double antenna_error_deg() const;

 private:
  enum class Phase { kTurning, kSounding, kStowing, kOver };

  void see(const AntennaState& antenna);
  bool is_settled(Time now) const;
  InstrumentCommand turn_to(const AntennaPose& pose, Phase phase, Time now);
  std::optional<InstrumentCommand> go_on(Time now);
  std::optional<InstrumentCommand> leave_out(Time now);

  WaterSoundingSettings settings_;
  AntennaPose stowed_;
  std::vector<AntennaPose> poses_;
  std::size_t next_ = 0;  ///< pose
  Phase phase_ = Phase::kTurning;
  bool has_begun_ = false, is_stowed_ = false;
  AntennaPose asked_;
  Time since_;  ///< of the phase
  std::optional<AntennaState> state_;
  std::optional<Time> steady_since_;
  std::vector<AimedSounding> soundings_;
  double sum_squared_error_rad2_ = 0.0;
  int left_out_ = 0, left_out_in_a_row_ = 0;
};

}  // namespace patrol::inspect
