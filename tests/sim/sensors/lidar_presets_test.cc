// Recovery of every lidar preset from its output. The expected values are written here, by the data sheets, so that a
// change of a preset fails.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sim/lidar_scans.h"
#include "tests/support/moments.h"

namespace patrol::sim::lidar_presets_test {
namespace {

struct ExpectedLidar {
  std::string preset;
  double rate_hz, fov_deg, step_deg;
  int rings;
  double range_min_m, range_max_m, max_range_10pct_m;
  double noise_std_m, quantization_m, angle_std_deg, dropout;
};

void PrintTo(const ExpectedLidar& expected, std::ostream* out) { *out << expected.preset; }

/// Beam of either kind of message: azimuth, elevation and range, NaN for lost beams of a scan.
struct Beam {
  double azimuth_rad, elevation_rad, range_m;
};

/// Revolutions of a lidar at rest, with its preset as it is.
struct Output {
  std::vector<std::vector<Beam>> revolutions;
  std::vector<Time> stamps;
};

Output output_of(const SmallWorld& world, const LidarSettings& settings, double seconds) {
  Lidar lidar(settings, world.scene, {}, settings.rings > 1 ? kRayLidar3d : kRayLidar2d, 3, "lidar");
  Output output;
  for (Time now{}; now < from_seconds(seconds); now += kTick) {
    lidar.advance(now, now + kTick, {}, {});
    for (const LaserScan& scan : lidar.take_scans()) {
      output.stamps.push_back(scan.stamp);
      std::vector<Beam>& beams = output.revolutions.emplace_back();
      for (std::size_t i = 0; i < scan.ranges_m.size(); ++i)
        beams.push_back({angle_of(scan, i), 0.0, scan.ranges_m[i]});
    }
    for (const PointCloud& cloud : lidar.take_clouds()) {
      output.stamps.push_back(cloud.stamp);
      std::vector<Beam>& beams = output.revolutions.emplace_back();
      for (const CloudPoint& point : cloud.points) {
        const double across = std::hypot(point.x, point.y);
        beams.push_back({std::atan2(point.y, point.x), std::atan2(point.z, across), std::hypot(across, point.z)});
      }
    }
  }
  return output;
}

class LidarPreset : public ::testing::TestWithParam<ExpectedLidar> {
 protected:
  const ExpectedLidar& expected() const { return GetParam(); }
  LidarSettings settings() const { return LidarSettings::of_preset(expected().preset); }
  /// Duration of a number of revolutions, s.
  double revolutions(int count) const { return count / expected().rate_hz + 0.001; }
  /// Firings per revolution.
  double firings() const { return std::round(expected().fov_deg / expected().step_deg) * expected().rings; }
  double quantization_var_m2() const { return std::pow(expected().quantization_m, 2) / 12.0; }
};

// Ahead at 2 m, beams within 30 degrees of the normal. There the beam angle adds at most 0.4 mm.
TEST_P(LidarPreset, RangeNoiseStepAndBiasAreThoseOfTheSheet) {
  const SmallWorld world(box("2.5 0 0", "0.5 20 20"));
  test::Moments errors;
  double smallest_odd = 0.0;
  int num_odd = 0;
  for (const std::vector<Beam>& beams : output_of(world, settings(), revolutions(25)).revolutions) {
    for (const Beam& beam : beams) {
      if (!std::isfinite(beam.range_m) || std::abs(beam.azimuth_rad) > 30.0 * kDegree) continue;
      errors.add(beam.range_m - 2.0 / (std::cos(beam.azimuth_rad) * std::cos(beam.elevation_rad)));
      const double steps = beam.range_m / expected().quantization_m;
      smallest_odd = std::max(smallest_odd, std::abs(steps - std::round(steps)));
      num_odd += std::llround(steps) % 2 != 0 ? 1 : 0;
    }
  }
  ASSERT_GT(errors.count, 3000);
  const double std_m = std::sqrt(std::pow(expected().noise_std_m, 2) + quantization_var_m2());
  EXPECT_NEAR(errors.std(), std_m, 4.0 * std_m / std::sqrt(2.0 * errors.count) + 1e-5);
  EXPECT_NEAR(errors.mean(), 0.0, 4.0 * std_m / std::sqrt(errors.count) + 1e-5);
  EXPECT_LT(smallest_odd, 0.01) << "ranges are whole steps";
  EXPECT_NEAR(num_odd, 0.5 * errors.count, 0.05 * errors.count) << "of no larger step";
}

// Walls at both sides, 2 m off, met by beams within 9 to 11 degrees of their surface: there the range changes by r /
// tan, 50 to 80 m per radian. What the range noise leaves of the variance is that of the angle; the tolerance is four
// standard deviations of the estimate for the noisiest preset.
TEST_P(LidarPreset, BeamAngleNoiseIsRecoveredFromWallsAtGrazingIncidence) {
  const SmallWorld world(box("0 2.5 0", "40 0.5 20") + box("0 -2.5 0", "40 0.5 20"));
  LidarSettings without_dark = settings();
  without_dark.max_range_10pct_m = 0.0;  // the reach is another test's
  const double range_var_m2 = std::pow(expected().noise_std_m, 2) + quantization_var_m2();
  double sum_rad2 = 0.0, weights = 0.0;
  for (const std::vector<Beam>& beams :
       output_of(world, without_dark, revolutions(300 / expected().rings)).revolutions) {
    for (const Beam& beam : beams) {
      const double off_axis_rad = std::abs(std::remainder(beam.azimuth_rad, kPi));
      if (!std::isfinite(beam.range_m) || off_axis_rad < 9.0 * kDegree || off_axis_rad > 11.0 * kDegree) continue;
      const double range_m = 2.0 / (std::sin(off_axis_rad) * std::cos(beam.elevation_rad));
      const double slope_m = range_m / std::tan(off_axis_rad), error_m = beam.range_m - range_m;
      sum_rad2 += slope_m * slope_m * (error_m * error_m - range_var_m2);
      weights += std::pow(slope_m, 4);
    }
  }
  ASSERT_GT(sum_rad2, 0.0);
  EXPECT_NEAR(std::sqrt(sum_rad2 / weights) / kDegree, expected().angle_std_deg, 0.2 * expected().angle_std_deg);
}

TEST_P(LidarPreset, RateFieldOfViewBeamsAndDropoutsAreThoseOfTheSheet) {
  const SmallWorld world(box("4.5 0 0", "0.5 5 5") + box("-4.5 0 0", "0.5 5 5") + box("0 4.5 0", "5 0.5 5") +
                         box("0 -4.5 0", "5 0.5 5"));
  const Output output = output_of(world, settings(), 2.0 + 1e-3);
  const auto num_revolutions = static_cast<double>(output.revolutions.size());
  EXPECT_EQ(num_revolutions, 2.0 * expected().rate_hz);
  EXPECT_NEAR(to_seconds(output.stamps.back() - output.stamps.front()), (num_revolutions - 1.0) / expected().rate_hz,
              1e-6);
  double num_valid = 0.0, low_rad = 0.0, high_rad = 0.0, low_elevation_rad = 0.0, high_elevation_rad = 0.0;
  for (const std::vector<Beam>& beams : output.revolutions) {
    for (const Beam& beam : beams) {
      if (!std::isfinite(beam.range_m)) continue;
      ++num_valid;
      low_rad = std::min(low_rad, beam.azimuth_rad), high_rad = std::max(high_rad, beam.azimuth_rad);
      low_elevation_rad = std::min(low_elevation_rad, beam.elevation_rad);
      high_elevation_rad = std::max(high_elevation_rad, beam.elevation_rad);
    }
  }
  EXPECT_NEAR((high_rad - low_rad) / kDegree, expected().fov_deg - expected().step_deg, 1.5 * expected().step_deg);
  EXPECT_NEAR(high_elevation_rad / kDegree, expected().rings > 1 ? 15.0 : 0.0, 1e-3);
  EXPECT_NEAR(low_elevation_rad / kDegree, expected().rings > 1 ? -15.0 : 0.0, 1e-3);
  const double num_fired = num_revolutions * firings();
  EXPECT_NEAR(1.0 - num_valid / num_fired, expected().dropout, 5.0 * std::sqrt(expected().dropout / num_fired));
}

/// Whether a wall straight ahead is returned by most beams within half a degree.
bool sees_wall(const LidarSettings& settings, double distance_m, const std::string& color) {
  const SmallWorld world(box(std::to_string(distance_m + 0.5) + " 0 0", "0.5 40 40", color));
  int num_returns = 0, num_beams = 0;
  for (const std::vector<Beam>& beams : output_of(world, settings, 1.001 / settings.rate_hz).revolutions) {
    for (const Beam& beam : beams) {
      if (std::abs(beam.azimuth_rad) > 0.5 * kDegree || std::abs(beam.elevation_rad) > 1.5 * kDegree) continue;
      ++num_beams;
      num_returns += std::isfinite(beam.range_m) ? 1 : 0;
    }
  }
  return 2 * num_returns > num_beams;  // a cloud without returns has no beams at all
}

TEST_P(LidarPreset, ReachOnWhiteAndOnTenPercentAndTheShortestRangeAreThoseOfTheSheet) {
  const std::string ten_percent = R"( rgba="0.1 0.1 0.1 1" )";
  EXPECT_TRUE(sees_wall(settings(), 0.98 * expected().range_max_m, kWhite));
  EXPECT_FALSE(sees_wall(settings(), 1.02 * expected().range_max_m, kWhite));
  EXPECT_TRUE(sees_wall(settings(), 0.97 * expected().max_range_10pct_m, ten_percent));
  EXPECT_FALSE(sees_wall(settings(), 1.03 * expected().max_range_10pct_m, ten_percent));
  EXPECT_TRUE(sees_wall(settings(), expected().range_min_m + 0.05, kWhite));
  EXPECT_FALSE(sees_wall(settings(), 0.8 * expected().range_min_m, kWhite));
}

INSTANTIATE_TEST_SUITE_P(
    AllPresets, LidarPreset,
    ::testing::Values(ExpectedLidar{"rplidar_s2", 10.0, 360.0, 0.1125, 1, 0.05, 30.0, 10.0, 0.015, 0.013, 0.01, 0.002},
                      ExpectedLidar{"utm30lx", 40.0, 270.25, 0.25, 1, 0.1, 30.0, 10.0, 0.015, 0.001, 0.01, 0.002},
                      ExpectedLidar{"tim571", 15.0, 270.33, 1.0 / 3.0, 1, 0.05, 25.0, 8.0, 0.02, 0.001, 0.01, 0.002},
                      ExpectedLidar{"vlp16", 10.0, 360.0, 0.2, 16, 0.5, 100.0, 50.0, 0.015, 0.002, 0.01, 0.002}),
    [](const auto& preset) { return preset.param.preset; });

}  // namespace
}  // namespace patrol::sim::lidar_presets_test
