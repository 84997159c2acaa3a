#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/angles.h"
#include "sim/sensors/lidar.h"
#include "tests/sim/small_world.h"

/// Scans of small worlds, for the lidar's tests.
namespace patrol::sim {

inline constexpr double kPi = std::numbers::pi;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr Time kTick = std::chrono::milliseconds(2);

inline const std::string kWhite = R"( rgba="1 1 1 1" )";

inline std::string box(const std::string& position, const std::string& size, const std::string& more = kWhite) {
  return R"(<geom type="box" pos=")" + position + R"(" size=")" + size + R"(" )" + more + "/>";
}

/// Everything perfect: no noise, no steps, no losses, no width.
inline LidarSettings ideal() {
  LidarSettings settings;
  settings.beams = 720;
  settings.range_noise_std_m = settings.range_quantization_m = settings.angle_noise_std_deg =
      settings.dropout_probability = 0.0;
  settings.max_incidence_deg = 90.0;
  settings.max_range_10pct_m = 0.0;
  settings.beam_width_deg = 0.0;
  return settings;
}

/// The scans of `seconds` from a lidar that is carried by `pose(now)`.
template <typename PoseAt>
std::vector<LaserScan> scans_along(const SmallWorld& world, const LidarSettings& settings, double seconds, PoseAt pose,
                                   std::uint64_t seed = 1) {
  Lidar lidar(settings, world.scene, {}, kRayLidar2d, seed, "lidar");
  std::vector<LaserScan> scans;
  for (Time now{}; now < from_seconds(seconds); now += kTick) {
    lidar.advance(now, now + kTick, pose(to_seconds(now)), pose(to_seconds(now + kTick)));
    for (LaserScan& scan : lidar.take_scans()) scans.push_back(std::move(scan));
  }
  return scans;
}

inline std::vector<LaserScan> scans_at_rest(const SmallWorld& world, const LidarSettings& settings, double seconds,
                                            std::uint64_t seed = 1) {
  return scans_along(
      world, settings, seconds, [](double) { return Pose3{}; }, seed);
}

inline double angle_of(const LaserScan& scan, std::size_t beam) {
  return scan.angle_min_rad + static_cast<double>(beam) * scan.angle_increment_rad;
}

/// A wall square ahead, seen by beams close to its normal.
inline const std::string kWallAt2m = box("2.5 0 0", "0.5 20 5");

inline LidarSettings narrow() {
  LidarSettings settings = ideal();
  settings.fov_deg = 2.0;
  settings.beams = 400;
  settings.rate_hz = 50.0;
  return settings;
}

}  // namespace patrol::sim
