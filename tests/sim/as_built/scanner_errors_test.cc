#include "sim/as_built/scanner_errors.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/sim/sensors/panoramic_scans.h"
#include "tests/support/moments.h"

namespace patrol::sim::scanner_errors_test {
namespace {

using panoramic_scanner_test::ideal;
using panoramic_scanner_test::kRoom;
using panoramic_scanner_test::next_scan;
using panoramic_scanner_test::position_of;

constexpr double kPi = std::numbers::pi, kArcSecond = kDegree / 3600.0;

TEST(ScannerErrors, ANominalScannerHasNone) {
  const BeamDeviation deviation = ScannerErrors().deviation(0.3, -0.7, false);
  EXPECT_EQ(deviation.left_rad, 0.0);
  EXPECT_EQ(deviation.up_rad, 0.0);
  EXPECT_EQ(deviation.left_m, 0.0);
  EXPECT_EQ(deviation.up_m, 0.0);
  EXPECT_EQ(ScannerErrors().range_error_m(7.0), 0.0);
}

// Both faces see one direction: the sum cancels collimation, trunnion, index and beam offset; the difference is twice
// each ([Medic19], two-face sensitivity).
TEST(ScannerErrors, AxisErrorsChangeTheirSignBetweenTheFaces) {
  ScannerErrors errors;
  errors.collimation_rad = 3e-5, errors.trunnion_rad = 5e-5, errors.vertical_index_rad = 7e-5;
  errors.beam_left_m = 1e-4, errors.beam_up_m = 2e-4;
  for (const double elevation_rad : {-0.9, 0.0, 1.2}) {
    const BeamDeviation front = errors.deviation(0.4, elevation_rad, true),
                        back = errors.deviation(0.4, elevation_rad, false);
    EXPECT_NEAR(front.left_rad, 3e-5 + 5e-5 * std::sin(elevation_rad), 1e-18);
    EXPECT_EQ(front.up_rad, 7e-5);
    EXPECT_EQ(back.left_rad, -front.left_rad);
    EXPECT_EQ(back.up_rad, -front.up_rad);
    EXPECT_EQ(back.left_m, -front.left_m);
    EXPECT_EQ(back.up_m, -front.up_m);
  }
}

TEST(ScannerErrors, AnEccentricHorizontalEncoderDisplacesBothFacesAlikeAndNothingAtTheZenith) {
  ScannerErrors errors;
  errors.horizontal_encoder_rad << 4e-5, 0.0, 0.0, 0.0;
  EXPECT_NEAR(errors.deviation(kPi / 2.0, 0.0, true).left_rad, 4e-5, 1e-18);
  EXPECT_NEAR(errors.deviation(kPi / 2.0, 0.0, false).left_rad, 4e-5, 1e-18);
  EXPECT_NEAR(errors.deviation(-kPi / 2.0, kPi / 3.0, true).left_rad, -2e-5, 1e-18);
  EXPECT_NEAR(errors.deviation(kPi / 2.0, kPi / 2.0, true).left_rad, 0.0, 1e-18);
}

// The mirror turns on past the zenith: the sine of its angle is that of the elevation at both faces, the cosine changes
// its sign, and an increase of the angle lowers the beam at the back face. Both faces agree at the zenith.
TEST(ScannerErrors, TheVerticalEncoderCountsOnPastTheZenith) {
  ScannerErrors errors;
  errors.vertical_encoder_rad << 4e-5, 3e-5, 2e-5, 0.0;
  const double e = 0.5, first = 4e-5 * std::sin(e), second = 3e-5 * std::cos(e), third = 2e-5 * std::sin(2.0 * e);
  EXPECT_NEAR(errors.deviation(0.0, e, true).up_rad, first + second + third, 1e-18);
  EXPECT_NEAR(errors.deviation(0.0, e, false).up_rad, -(first - second - third), 1e-18);
  EXPECT_NEAR(errors.deviation(0.0, kPi / 2.0, true).up_rad, -errors.deviation(0.0, kPi / 2.0, false).up_rad, 1e-18);
}

TEST(ScannerErrors, TheCyclicErrorRepeatsWithTheWavelengthAndTheScaleGrows) {
  ScannerErrors errors;
  errors.cyclic_sine_m = 2e-4, errors.cyclic_wavelength_m = 0.6;
  EXPECT_NEAR(errors.range_error_m(6.15), 2e-4, 1e-12);
  EXPECT_NEAR(errors.range_error_m(6.45), -2e-4, 1e-12);
  EXPECT_NEAR(errors.range_error_m(12.0), 0.0, 1e-12);
  errors.range_scale = 1e-5;
  EXPECT_NEAR(errors.range_error_m(12.0), 1.2e-4, 1e-12);
}

// FARO's sheet: 19" and +-1 mm, noise included.
TEST(ScannerErrors, TheDefaultsWithTheirNoiseAreWithinTheSheet) {
  const ScannerTolerances tolerances;
  constexpr int kSeeds = 3000;
  double left = 0.0, up = 0.0, range = 0.0;
  test::Moments collimation;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const ScannerErrors errors = sample_scanner_errors(tolerances, seed);
    collimation.add(errors.collimation_rad);
    const RandomStream beam(seed, "test/beam");
    const double head_rad = kPi * (beam.uniform(0) - 0.5), elevation_rad = std::asin(2.0 * beam.uniform(1) - 1.0);
    const BeamDeviation deviation = errors.deviation(head_rad, elevation_rad, beam.uniform(2) < 0.5);
    left += deviation.left_rad * deviation.left_rad / kSeeds;
    up += deviation.up_rad * deviation.up_rad / kSeeds;
    range += std::pow(errors.range_error_m(15.0 * beam.uniform(3)), 2) / kSeeds;
  }
  EXPECT_NEAR(collimation.std(), 8.0 * kArcSecond, 4.0 * 8.0 * kArcSecond / std::sqrt(2.0 * kSeeds));
  const double noise = tolerances.angle_noise_ratio * 19.0 * kArcSecond;
  EXPECT_NEAR(std::sqrt(left), 12.0 * kArcSecond, 1.0 * kArcSecond);
  EXPECT_NEAR(std::sqrt(up), 12.0 * kArcSecond, 1.0 * kArcSecond);
  EXPECT_NEAR(std::sqrt(0.5 * (left + up) + noise * noise), 19.0 * kArcSecond, 1.0 * kArcSecond);
  EXPECT_NEAR(std::sqrt(range + std::pow(tolerances.range_offset_ratio * 5e-4, 2)), 5e-4, 0.5e-4);
}

TEST(ScannerErrors, EachTermIsSampledOnItsOwn) {
  ScannerTolerances some;
  some.collimation_std_arcsec = 0.0, some.cyclic_range_std_m = 0.0;
  const ScannerErrors all = sample_scanner_errors({}, 5), fewer = sample_scanner_errors(some, 5);
  EXPECT_EQ(fewer.collimation_rad, 0.0);
  EXPECT_EQ(fewer.trunnion_rad, all.trunnion_rad);
  EXPECT_EQ(fewer.vertical_encoder_rad, all.vertical_encoder_rad);
  EXPECT_EQ(fewer.range_scale, all.range_scale);
  EXPECT_NE(all.trunnion_rad, sample_scanner_errors({}, 6).trunnion_rad);
}

/// Returns a scan of the room by a scanner with the given errors.
PanoramicScan scan_with(const ScannerErrors& errors) {
  static const SmallWorld world(kRoom);
  PanoramicScanner scanner(ideal(), world.scene, {}, 1, {}, errors);
  return next_scan(scanner, ideal().duration_s);
}

// The scanner reports the nominal direction with the range of the actual one: the wall ahead at x = 4 m, seen along (c,
// s) in its plane of incidence, has the range 4 / cos of the actual angle.
TEST(ScannerErrors, ACollimationErrorIsReportedAsATiltOfTheWallsInOppositeSensesAheadAndBehind) {
  ScannerErrors errors;
  errors.collimation_rad = 1e-3;
  int ahead = 0, behind = 0;
  for (const ScannerPoint& point : scan_with(errors).points) {
    const Eigen::Vector3d p = position_of(point);
    if (std::abs(p.z()) > 1e-6 || std::abs(p.y()) < 0.5 || std::abs(p.y()) > 2.5 || std::abs(p.x()) < 3.0) continue;
    const bool is_ahead = p.x() > 0.0;
    const double actual_rad = std::atan2(p.y(), p.x()) + (is_ahead ? 1e-3 : -1e-3);
    EXPECT_NEAR(p.norm(), 4.0 / std::abs(std::cos(actual_rad)), 1e-5);
    ++(is_ahead ? ahead : behind);
  }
  EXPECT_GT(ahead, 10);
  EXPECT_EQ(ahead, behind);
}

TEST(ScannerErrors, AnOffsetOfTheBeamTurnsWithTheHeadAndNearWallsShowIt) {
  ScannerErrors errors;
  errors.beam_left_m = 0.01;
  int looked = 0;
  for (const ScannerPoint& point : scan_with(errors).points) {
    const Eigen::Vector3d p = position_of(point);
    if (std::abs(p.z()) > 1e-6 || p.x() < 3.0 || std::abs(p.y()) > 2.5) continue;
    const double azimuth = std::atan2(p.y(), p.x());
    // The ray starts at 0.01 (-sin, cos) and meets x = 4.
    EXPECT_NEAR(p.norm(), (4.0 + 0.01 * std::sin(azimuth)) / std::cos(azimuth), 1e-5);
    ++looked;
  }
  EXPECT_GT(looked, 10);
}

TEST(ScannerErrors, RangeErrorsAreInTheReportedRange) {
  ScannerErrors errors;
  errors.range_scale = 1e-3;
  for (const ScannerPoint& point : scan_with(errors).points) {
    const Eigen::Vector3d p = position_of(point);
    EXPECT_NEAR(p.norm(), 1.001 * panoramic_scanner_test::room_range(p.normalized()), 2e-5);
  }
}

}  // namespace
}  // namespace patrol::sim::scanner_errors_test
