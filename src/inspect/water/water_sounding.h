#pragma once

#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/settings.h"

namespace patrol::inspect {

/// How the antenna is set for soundings ahead of the face. A body's response is a quadratic form of the coil's axis: six numbers a gate,
/// which few directions would give; 35, as the paper's robot takes, spread as far as the mount turns, tell the form from steel and noise.
struct WaterSoundingSettings {
  int yaws = 7;
  double max_yaw_deg = 60.0;    ///< -60 ... 60 in steps of 20
  int pitches = 5;
  double max_pitch_deg = 30.0;  ///< -30 ... 30 in steps of 15
  double settled_deg = 0.5;     ///< the antenna is there when its servos read this close to what was asked, and no longer change
  double settle_s = 0.4;        ///< for so long
  double turn_timeout_s = 8.0;  ///< then the pose is left out
  double sounding_timeout_s = 5.0;
  int give_up_after = 3;        ///< poses left out in a row

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("yaws", self.yaws, between(1, 50));
    visit("max_yaw_deg", self.max_yaw_deg, between(0.0, 90.0));
    visit("pitches", self.pitches, between(1, 50));
    visit("max_pitch_deg", self.max_pitch_deg, between(0.0, 80.0));
    visit("settled_deg", self.settled_deg, between(0.05, 10.0));
    visit("settle_s", self.settle_s, between(0.0, 10.0));
    visit("turn_timeout_s", self.turn_timeout_s, between(0.1, 120.0));
    visit("sounding_timeout_s", self.sounding_timeout_s, between(0.1, 600.0));
    visit("give_up_after", self.give_up_after, between(1, 1000));
  }
};

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

  void handle(const AntennaState& state);
  void handle(const TemSounding& sounding);

  /// At any rate above a few hertz: the next order, if there is one.
  std::optional<InstrumentCommand> step(Time now);

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
  std::optional<TemSounding> heard_;
  std::vector<AimedSounding> soundings_;
  double sum_squared_error_rad2_ = 0.0;
  int left_out_ = 0, left_out_in_a_row_ = 0;
};

}  // namespace patrol::inspect
