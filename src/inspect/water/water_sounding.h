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

/// Returns the antenna poses in boustrophedon order. Throws InputError with the setting if the mount cannot reach a
/// pose.
std::vector<AntennaPose> antenna_poses(const WaterSoundingSettings& settings, const AntennaGeometry& antenna);

/// Sounding with the encoder angles of the coil.
struct OrientedSounding {
  AntennaPose pose;
  TemSounding sounding;
};

/// Sequence of soundings at one station. Turns the antenna to each pose, waits until the encoders confirm it, requests
/// a sounding, and stows the antenna at the end. The robot must be stationary.
class WaterSounding {
 public:
  WaterSounding(const WaterSoundingSettings& settings, const AntennaGeometry& antenna, Time start);

  /// Advances the sequence and returns the next command, if any. Call at a few hertz or more with the latest messages.
  std::optional<InstrumentCommand> step(Time now, const std::optional<AntennaState>& antenna,
                                        const std::optional<TemSounding>& sounding);

  bool is_over() const { return phase_ == Phase::kOver; }
  /// Returns whether the encoders confirm the stowed pose; valid when the sequence is over. If not, the robot should
  /// not drive.
  bool is_stowed() const { return is_stowed_; }
  const std::vector<OrientedSounding>& soundings() const { return soundings_; }
  int num_poses() const { return static_cast<int>(poses_.size()); }
  int num_skipped() const { return num_skipped_; }
  /// Returns the root mean square angle between commanded and measured axes over the soundings.
  double antenna_error_deg() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(stowed_, poses_, next_, phase_, has_begun_, is_stowed_, commanded_, since_, state_, steady_since_,
            soundings_, sum_squared_error_rad2_, num_skipped_, num_skipped_in_a_row_);
  }

 private:
  enum class Phase { kTurning, kSounding, kStowing, kOver };

  void on_antenna_state(const AntennaState& state);
  bool is_settled(Time now) const;
  InstrumentCommand command_pose(const AntennaPose& pose, Phase phase, Time now);
  std::optional<InstrumentCommand> next_command(Time now);
  std::optional<InstrumentCommand> skip_pose(Time now);

  WaterSoundingSettings settings_;
  AntennaPose stowed_;
  std::vector<AntennaPose> poses_;
  std::size_t next_ = 0;  ///< index of the next pose
  Phase phase_ = Phase::kTurning;
  bool has_begun_ = false, is_stowed_ = false;
  AntennaPose commanded_;
  Time since_;  ///< start of the phase
  std::optional<AntennaState> state_;
  std::optional<Time> steady_since_;
  std::vector<OrientedSounding> soundings_;
  double sum_squared_error_rad2_ = 0.0;
  int num_skipped_ = 0, num_skipped_in_a_row_ = 0;
};

}  // namespace patrol::inspect
