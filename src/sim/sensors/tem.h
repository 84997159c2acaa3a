#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "core/tem_response.h"
#include "sim/water_ahead.h"

namespace patrol::sim {

/// The coil among rock and water. Bodies add up: that one screens another is left out. Steel is a sum of three exponential decays
/// (15, 60, 250 us), near t^-1 in between, that changes with the coil's direction as a quadratic form of its axis; drawn for the run.
///
/// Not modelled: the tunnel's air, the receiver's low-pass (the instrument takes its delay out; what is left is the time shift), polarisation of
/// the rock, mains and radio.
class Tem {
 public:
  /// Throws InputError for gates that are none.
  Tem(const TemSettings& settings, const RockSettings& rock, const std::vector<WaterBodySettings>& bodies, std::uint64_t seed);

  /// Begins a sounding, unless one is under way.
  void start(Time now);
  bool is_sounding() const { return start_.has_value(); }

  /// Once a tick, with the coil's true pose (its axis is x). Gives the sounding at its end.
  std::optional<TemSounding> step(const Pose3& T_world_tem, Time now);

  /// Sounding number `count`, of a coil at `p_world` whose axis a has the mean outer product `axes` = <a a^T> over the stack.
  TemSounding sound(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& axes, std::uint64_t count, Time end) const;

 private:
  TemSettings settings_;
  RockSettings rock_;
  std::vector<WaterBodySettings> bodies_;
  TemWindow window_;  ///< as reported
  TemGates gates_;    ///< as they really are, shifted
  double gain_ = 1.0, steel_rate_ = 0.0;
  Eigen::Matrix3d steel_form_ = Eigen::Matrix3d::Zero();
  RandomStream noise_, relative_noise_, current_;
  std::optional<Time> start_;
  std::uint64_t count_ = 0;
  int ticks_ = 0;
  Eigen::Vector3d sum_p_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sum_axes_ = Eigen::Matrix3d::Zero();
};

}  // namespace patrol::sim
