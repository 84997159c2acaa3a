#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "core/teleop_route.h"

namespace patrol::sim {

/// Settings of the simulated operator that drives the robot along a route.
struct TeleopOperatorSettings {
  double speed_mps = 0.8;                   ///< forward speed of the operator's commands
  double yaw_rate_radps = 0.6;              ///< yaw rate of a turn in place
  double reaction_time_s = 0.25;            ///< delay from an observation to the resulting command
  double steering_noise_std_radps = 0.03;   ///< standard deviation of the steering noise added to each command
  double pedestrian_stop_distance_m = 2.0;  ///< distance to a person ahead of the robot at which the operator stops
  double rate_hz = 10.0;                    ///< rate of the operator's commands
  /// Whether the operator waits at the first waypoint until the robot has arrived and stands still.
  bool wait_for_robot = false;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_mps", self.speed_mps, between(0.05, 2.0));
    visit("yaw_rate_radps", self.yaw_rate_radps, between(0.05, 2.0));
    visit("reaction_time_s", self.reaction_time_s, between(0.0, 2.0));
    visit("steering_noise_std_radps", self.steering_noise_std_radps, between(0.0, 1.0));
    visit("pedestrian_stop_distance_m", self.pedestrian_stop_distance_m, between(0.0, 10.0));
    visit("rate_hz", self.rate_hz, between(1.0, 50.0));
    visit("wait_for_robot", self.wait_for_robot);
  }
};

/// Teleoperator who walks behind the robot, observes its pose and drives it along a route by pure pursuit [Coulter92].
/// Reaction time and steering noise are modeled.
///
/// At goal waypoints the operator stops, turns the robot to the heading, presses the button and waits while the robot
/// is busy. At the end the operator hands over control.
class TeleopOperator {
 public:
  /// `drive` is in world.
  TeleopOperator(const TeleopOperatorSettings& settings, TeleopRoute drive, std::uint64_t seed);

  /// Returns a command when one is due. Call at every tick. Returns nothing before operator and robot have met and
  /// after the handover.
  std::optional<TeleopCommand> step(Time now, const Pose2& T_world_body,
                                    const std::vector<Eigen::Vector2d>& p_world_people, bool is_busy = false);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(phase_, next_, leg_start_m_, has_started_, stationary_since_, phase_start_, count_, observed_);
  }

 private:
  enum class Phase { kWaiting, kDriving, kTurning, kLooking, kSaved, kDone };

  bool robot_has_arrived(Time now, const Pose2& T_world_body);
  TeleopCommand decide(Time now, const Pose2& T_world_body, const std::vector<Eigen::Vector2d>& p_world_people,
                       bool is_busy);
  void drive(const Pose2& T_world_body, TeleopCommand& command);
  void rotate_to(double yaw_rad, const Pose2& T_world_body, TeleopCommand& command) const;
  bool has_passed_waypoint(const Pose2& T_world_body) const;
  bool is_pedestrian_ahead(const Pose2& T_world_body, const std::vector<Eigen::Vector2d>& p_world_people) const;
  Eigen::Vector2d pursuit_point(const Eigen::Vector2d& p_world_body) const;
  const TeleopWaypoint& waypoint() const { return drive_[next_]; }

  TeleopOperatorSettings settings_;
  TeleopRoute drive_;
  RandomStream steering_noise_;
  Phase phase_ = Phase::kDriving;
  std::size_t next_ = 0;
  Eigen::Vector2d leg_start_m_ = Eigen::Vector2d::Zero();
  bool has_started_ = false;
  std::optional<std::pair<Time, Pose2>> stationary_since_;  ///< start of the present standstill, while waiting for the
                                                            ///< robot
  Time phase_start_{};
  std::uint64_t count_ = 0;
  std::deque<std::pair<Time, Pose2>> observed_;
};

}  // namespace patrol::sim
