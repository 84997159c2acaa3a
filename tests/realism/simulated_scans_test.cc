#include "realism/simulated_scans.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "realism/expected_scan.h"
#include "tests/realism/sites.h"

namespace patrol::realism {
namespace {

using test::kPi;

LidarDevice ideal_device() {
  LidarDevice device;
  LidarSettings& lidar = device.settings;
  lidar.range_noise_std_m = lidar.range_quantization_m = lidar.angle_noise_std_deg = lidar.beam_width_deg = 0.0;
  lidar.dropout_probability = lidar.false_return_rate_per_m = 0.0;
  lidar.max_incidence_deg = 90.0;
  lidar.max_range_10pct_m = 0.0;
  return device;
}

TEST(SimulatedScans, OfAnIdealLidarAreTheExpectedBeamsWhateverTheFieldOfViewAndTheDirection) {
  const Site site = test::site_of(test::room());
  PosedScan moving = test::posed_scan(400, 1.5 * kPi, {0.2, 0.1, 0.4});
  moving.scan.angle_min_rad = -1.0;  // not symmetric
  moving.scan.time_increment_s = 1e-4;
  moving.T_site_lidar = {to_pose3({0.2, 0.1, 0.4}), to_pose3({0.25, 0.1, 0.45}), to_pose3({0.3, 0.15, 0.55})};
  PosedScan clockwise = test::posed_scan(180, kPi, {-0.5, 0.3, 2.0});
  clockwise.scan.angle_min_rad = kPi / 2.0;
  clockwise.scan.angle_increment_rad *= -1.0;
  const std::vector<PosedScan> scans = {test::posed_scan(360), moving, clockwise, clockwise};
  const std::vector<std::vector<float>> ranges_m = simulate_scans(site, ideal_device(), scans, 1);
  ASSERT_EQ(ranges_m.size(), scans.size());
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::vector<ExpectedBeam> expected = expected_beams(site, scans[k], {});
    ASSERT_EQ(ranges_m[k].size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(ranges_m[k][i], expected[i].range_m, 1e-4) << k << ", beam " << i;
  }
}

TEST(SimulatedScans, HaveThePlantedNoiseAndOffset) {
  const Site site = test::site_of(test::room());
  LidarDevice device = ideal_device();
  device.settings.range_noise_std_m = 0.02;
  device.errors.range_offset_m = 0.03;
  const std::vector<PosedScan> scans(20, test::posed_scan(360));
  double sum = 0.0, squares = 0.0, count = 0.0;
  const std::vector<std::vector<float>> ranges_m = simulate_scans(site, device, scans, 3);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::vector<ExpectedBeam> expected = expected_beams(site, scans[k], {});
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double residual_m = static_cast<double>(ranges_m[k][i]) - expected[i].range_m;
      sum += residual_m, squares += residual_m * residual_m, count += 1.0;
    }
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.03, 0.001);  // 4 standard deviations of the mean of 7200
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.02, 0.0007);
}

TEST(SimulatedScans, RefuseMoreThanOneRevolution) {
  const Site site = test::site_of(test::room());
  EXPECT_THROW(simulate_scans(site, ideal_device(), {test::posed_scan(361, to_rad(361.0))}, 1), InputError);
  EXPECT_THROW(simulate_scans(site, ideal_device(), {test::posed_scan(3, to_rad(0.5))}, 1), InputError);
}

}  // namespace
}  // namespace patrol::realism
