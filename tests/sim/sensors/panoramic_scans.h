#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/sensors/panoramic_scanner.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::panoramic_scanner_test {

inline std::string box(const std::string& position, const std::string& size, double grey = 1.0,
                       const std::string& more = "") {
  const std::string g = std::to_string(grey);
  return R"(<geom type="box" pos=")" + position + R"(" size=")" + size + R"(" rgba=")" + g + " " + g + " " + g +
         R"( 1" )" + more + "/>";
}

/// Walls at +-4 m in x and +-3 m in y, ceiling 3 m above, floor 2 m below.
const std::string kRoom = box("4.5 0 0", "0.5 4 4") + box("-4.5 0 0", "0.5 4 4") + box("0 3.5 0", "5 0.5 4") +
                          box("0 -3.5 0", "5 0.5 4") + box("0 0 3.5", "5 4 0.5") + box("0 0 -2.5", "5 4 0.5");

inline double room_range(const Eigen::Vector3d& direction) {
  const double up = direction.z() > 0.0 ? 3.0 / direction.z() : direction.z() < 0.0 ? -2.0 / direction.z() : 1e9;
  return std::min({4.0 / std::abs(direction.x()), 3.0 / std::abs(direction.y()), up});
}

inline Eigen::Vector3d position_of(const ScannerPoint& point) { return {point.x, point.y, point.z}; }

/// Everything perfect, and few directions.
inline PanoramicScannerSettings ideal() {
  PanoramicScannerSettings settings;
  settings.enabled = true;
  settings.step_deg = 2.0;
  settings.range_noise_std_m = settings.gray_noise_std_m = settings.range_offset_std_m = settings.angle_noise_std_deg =
      0.0;
  settings.tilt_error_std_deg = settings.beam_divergence_rad = settings.dropout_probability = 0.0;
  settings.max_incidence_deg = 90.0;
  settings.range_min_m = 0.0;
  return settings;
}

using PoseAt = std::function<Pose3(double now_s)>;

/// The next scan of a scanner that is the body itself, carried along.
inline PanoramicScan next_scan(
    PanoramicScanner& scanner, double duration_s, const PoseAt& pose = [](double) { return Pose3{}; }) {
  scanner.begin(Time{}, pose(0.0));
  const Time tick = from_seconds(duration_s / 60.0);
  for (Time now{}; scanner.is_busy(); now += tick)
    scanner.advance(now, now + tick, pose(to_seconds(now)), pose(to_seconds(now + tick)));
  return std::move(scanner.take_scans().at(0));
}

inline PanoramicScan scan(
    const SmallWorld& world, const PanoramicScannerSettings& settings, std::uint64_t seed = 1,
    const PoseAt& pose = [](double) { return Pose3{}; }, const DustSettings& dust = {}) {
  PanoramicScanner scanner(settings, world.scene, {}, seed, dust);
  return next_scan(scanner, settings.duration_s, pose);
}

/// Range by beam (azimuth and elevation in steps), of those that look within some degrees of +x.
inline std::map<std::pair<long, long>, double> ranges_ahead(const PanoramicScan& scan, double step_deg,
                                                            double within_deg) {
  std::map<std::pair<long, long>, double> ranges_m;
  for (const ScannerPoint& point : scan.points) {
    const Eigen::Vector3d p = position_of(point), direction = p.normalized();
    if (direction.x() < std::cos(within_deg * kDegree)) continue;
    const double azimuth_deg = std::atan2(direction.y(), direction.x()) / kDegree,
                 elevation_deg = std::asin(direction.z()) / kDegree;
    ranges_m[{std::lround(azimuth_deg / step_deg), std::lround(elevation_deg / step_deg)}] = p.norm();
  }
  return ranges_m;
}

/// Measured range less that of the flawless scan, m; of beams that look within some degrees of +x.
inline test::Moments range_errors(const SmallWorld& world, const PanoramicScannerSettings& settings,
                                  double within_deg) {
  PanoramicScannerSettings flawless = ideal();
  flawless.step_deg = settings.step_deg;
  flawless.elevation_min_deg = settings.elevation_min_deg;
  const auto measured = ranges_ahead(scan(world, settings), settings.step_deg, within_deg);
  const auto exact = ranges_ahead(scan(world, flawless), settings.step_deg, within_deg);
  EXPECT_EQ(measured.size(), exact.size());
  test::Moments errors;
  for (const auto& [beam, range_m] : exact) errors.add(measured.at(beam) - range_m);
  return errors;
}

const PoseAt kTilted = [](double) { return Pose3{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.02, -0.015, 0.4)}; };

/// Bits of beams that drop out in a room, of a grid without another imperfection.
inline std::vector<bool> dropouts(const std::string& epoch, std::uint64_t seed) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.epoch = epoch;
  settings.dropout_probability = 0.1;
  const auto complete = ranges_ahead(scan(world, ideal()), settings.step_deg, 60.0);
  const auto taken = ranges_ahead(scan(world, settings, seed), settings.step_deg, 60.0);
  std::vector<bool> is_lost;
  for (const auto& [beam, range_m] : complete) is_lost.push_back(!taken.contains(beam));
  return is_lost;
}

}  // namespace patrol::sim::panoramic_scanner_test
