#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/as_built/uwb_power.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// Begin of the names of the MJCF sites of UWB anchors.
inline constexpr std::string_view kUwbAnchor = "uwb_anchor_";

/// UWB anchor: a site `uwb_anchor_<number>` of the world.
struct UwbAnchor {
  int number = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< position, m
};

/// Returns the anchors sorted by number; empty if the world has none.
std::vector<UwbAnchor> uwb_anchors(const mjModel& view);

/// Returns the range bias of an uncorrected DW1000 at a distance, m. APS011 table 2 (500 MHz, 64 MHz pulse repetition)
/// at the signal level after free-space loss, for -41.3 dBm/MHz in channel 2. `power_offset_db`: received power above
/// that of isotropic antennas.
double uwb_range_bias_m(double distance_m, double power_offset_db = 0.0);

/// UWB antenna of the robot. Each poll addresses one anchor and returns its range unless it is lost.
///
/// A path is non-line-of-sight when most of seven lines through the center of the first Fresnel zone are blocked. A
/// cable does not block it; a person, a pillar or the robot's own mast does. Not modeled: interference by other tags,
/// ranges through thin walls, and growth of NLOS bias and loss with the obstruction.
class Uwb {
 public:
  /// Throws InputError when the world has no anchors. `power`: received power relative to isotropic antennas.
  Uwb(const UwbSettings& settings, const mjModel& view, std::uint64_t seed, const UwbPower& power = {});

  /// Returns the range of poll number `tick`, which addresses the next anchor in range; none if it is lost.
  std::optional<UwbRange> read(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna, Time now,
                               std::uint64_t tick);

  const std::vector<UwbAnchor>& anchors() const { return anchors_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(turn_);
  }

 private:
  const UwbAnchor* next_in_range(const Eigen::Vector3d& p_world_antenna);

  UwbSettings settings_;
  std::vector<UwbAnchor> anchors_;
  UwbPower power_;
  RandomStream noise_, loss_, nlos_loss_, nlos_bias_;
  std::size_t turn_ = 0;  ///< index of the next anchor to poll
};

/// Returns whether the path between antenna and anchor is non-line-of-sight.
bool is_uwb_path_nlos(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna,
                      const Eigen::Vector3d& p_world_anchor);

}  // namespace patrol::sim
