#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// A site `uwb_anchor_<number>` of the world.
struct UwbAnchor {
  int number = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< m
};

/// In order of number; empty where the world has none.
std::vector<UwbAnchor> uwb_anchors(const mjModel& view);

/// What an uncorrected DW1000 reads too much at a true distance, m: APS011 table 2 (500 MHz, 64 MHz pulse repetition) over
/// the signal level that free space leaves of -41.3 dBm/MHz in channel 2.
double uwb_range_bias_m(double distance_m);

/// The robot's antenna. Each poll asks one anchor and gives its range, unless that is lost.
///
/// A path is blocked when most of seven lines through the middle of the first Fresnel zone are: a cable does not, a man, a
/// pillar or the robot's own mast does. Not modelled: the signal's strength by the antennas' direction, interference by other
/// tags, ranges through thin walls, and that excess and loss grow with what is in the way.
class Uwb {
 public:
  /// Throws InputError when the world has no anchors.
  Uwb(const UwbSettings& settings, const mjModel& view, std::uint64_t seed);

  /// Poll number `tick`; the next anchor within reach is asked.
  std::optional<UwbRange> read(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna, Time now,
                               std::uint64_t tick);

  const std::vector<UwbAnchor>& anchors() const { return anchors_; }

 private:
  const UwbAnchor* next_in_reach(const Eigen::Vector3d& p_world_antenna);

  UwbSettings settings_;
  std::vector<UwbAnchor> anchors_;
  RandomStream noise_, loss_, blocked_loss_, excess_;
  std::size_t turn_ = 0;  ///< index of the anchor to ask next
};

/// True when something stands between antenna and anchor.
bool is_uwb_path_blocked(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna,
                         const Eigen::Vector3d& p_world_anchor);

}  // namespace patrol::sim
