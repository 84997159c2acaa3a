#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// Ultra-wideband two-way ranging, after Decawave's DW1000: data sheet (ranges to about 10 cm) and application note APS011
/// "Sources of error in DW1000 based two-way ranging schemes" (bias). A range whose path is blocked is too long by an
/// exponential excess: Alsindi, Alavi, Pahlavan, "Measurement and modeling of ultrawideband TOA-based ranging in indoor
/// multipath environments", IEEE Trans. Vehicular Technology 58(3), 2009, and Bellusci et al., "Modeling distance and
/// bandwidth dependency of TOA-based UWB ranging error for positioning", 2009: Gaussian in sight, Gaussian and exponential
/// out of sight. Rates of loss are assumptions.
struct UwbSettings {
  bool enabled = false;
  double rate_hz = 30.0;            ///< polls in all; the anchors within reach take turns
  double range_max_m = 60.0;        ///< anchors farther away do not answer and are not asked
  double range_noise_m = 0.07;      ///< standard deviation, in sight
  double bias_scale = 1.0;          ///< of the bias by distance; 0: the firmware corrects it
  double loss = 0.02;               ///< share of polls close by that get no answer
  double blocked_loss = 0.3;        ///< share lost of those whose path is blocked, besides
  double blocked_excess_m = 0.4;    ///< mean of the exponential excess of a blocked path
  double latency_s = 0.01;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 500.0));
    visit("range_max_m", self.range_max_m, between(1.0, 1000.0));
    visit("range_noise_m", self.range_noise_m, at_least(0.0));
    visit("bias_scale", self.bias_scale, between(-5.0, 5.0));
    visit("loss", self.loss, between(0.0, 1.0));
    visit("blocked_loss", self.blocked_loss, between(0.0, 1.0));
    visit("blocked_excess_m", self.blocked_excess_m, at_least(0.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

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
