#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace patrol::sim {

/// Received power of ultra-wideband signals relative to isotropic antennas, on which the range bias of the receiver
/// depends. The gain of the robot's antenna and that of each anchor deviate by a constant; the gain of an anchor also
/// varies with the azimuth of the robot, once around, because of what it is mounted on.
class UwbPower {
 public:
  /// Isotropic antennas.
  UwbPower() = default;
  /// `std_db`: standard deviation of each of the three parts.
  UwbPower(double std_db, std::uint64_t seed) : std_db_(std_db), seed_(seed) {}

  /// Returns the offset of the received power. `anchor_to_robot`: direction, in world.
  double offset_db(int anchor, const Eigen::Vector3d& anchor_to_robot) const;

 private:
  double std_db_ = 0.0;
  std::uint64_t seed_ = 0;
};

}  // namespace patrol::sim
