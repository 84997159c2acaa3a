#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/sensors/tem_response.h"
#include "core/settings.h"
#include "sim/subsurface.h"
#include "sim/tem/subsurface_response.h"

namespace patrol::sim {

/// TEM coil in conductive rock with tunnel, fault zone and water bodies (sim/tem/subsurface_response.h).
///
/// The response of steel is a sum of three exponential decays (15, 60, 250 us), close to t^-1 in between. It depends on
/// the coil direction as a quadratic form of its axis and is sampled once per run. Not modeled: the receiver's low-pass
/// filter (the instrument corrects its delay; the time shift is the residual), polarization of the rock, power lines
/// and radio.
class Tem {
 public:
  /// Throws InputError for fewer than three gates.
  Tem(const TemSettings& settings, const RockSettings& rock, std::vector<WaterBodySettings> bodies, std::uint64_t seed);

  /// Starts a sounding unless one is in progress.
  void start(Time now);
  bool is_sounding() const { return start_.has_value(); }

  /// Accumulates the ground-truth pose of the coil (its axis is x). Call once per tick. Returns the sounding when it is
  /// complete.
  std::optional<TemSounding> step(const Pose3& T_world_tem, Time now);

  /// Returns sounding number `count` of a coil at `p_world` whose axis a has the mean outer product `axes` = <a a^T>
  /// over the stack.
  TemSounding sound(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& axes, std::uint64_t count, Time end) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(start_, count_, ticks_, sum_p_, sum_axes_);
  }

 private:
  TemSettings settings_;
  TemGateLayout window_;  ///< reported gates
  SubsurfaceResponse subsurface_;
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
