#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"

namespace patrol::test {

/// Anchors every `spacing_m` along x, on alternating walls, from `from_m` to `to_m`; in `map`.
inline std::vector<UwbAnchor> make_tunnel_anchors(double from_m, double to_m, double spacing_m = 20.0,
                                                  double wall_m = 5.0, double height_m = 2.5) {
  std::vector<UwbAnchor> anchors;
  for (double x = from_m; x <= to_m; x += spacing_m) {
    const int number = static_cast<int>(anchors.size()) + 1;
    anchors.push_back({.number = number, .p_m = {x, number % 2 == 0 ? -wall_m : wall_m, height_m}});
  }
  return anchors;
}

/// Ranges by the model of core/uwb.h: noise, and an exponential excess on those off the line of sight.
struct UwbPolls {
  struct Poll {
    UwbRange range;
    bool is_nlos = false;
  };
  std::vector<UwbAnchor> anchors;
  UwbCalibration calibration{};
  double nlos_probability = 0.0;
  double nlos_bias_m = 0.5;
  double range_max_m = 50.0;

  /// Poll number `tick`: the anchors within reach take turns; none if there is none.
  std::optional<Poll> poll(std::uint64_t seed, std::uint64_t tick, Time now, const Pose3& T_map_body,
                           const Pose3& T_body_uwb) const {
    const Eigen::Vector3d antenna = (T_map_body * T_body_uwb).position;
    std::vector<UwbAnchor> near;
    std::copy_if(anchors.begin(), anchors.end(), std::back_inserter(near),
                 [&](const UwbAnchor& anchor) { return (antenna - anchor.p_m).norm() <= range_max_m; });
    if (near.empty()) return std::nullopt;
    const UwbAnchor& anchor = near[tick % near.size()];
    const double distance = (antenna - anchor.p_m).norm();
    Poll poll{.range = {.stamp = now, .anchor = anchor.number}};
    poll.is_nlos = RandomStream(seed, "uwb/blocked").uniform(tick) < nlos_probability;
    poll.range.range_m = distance + uwb_bias_at(calibration, distance).bias_m +
                         calibration.range_std_m * RandomStream(seed, "uwb/noise").normal(tick);
    if (poll.is_nlos) poll.range.range_m -= nlos_bias_m * std::log(RandomStream(seed, "uwb/excess").uniform(tick));
    return poll;
  }
};

}  // namespace patrol::test
