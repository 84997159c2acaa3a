#include "localize/rest_detector.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::localize::rest_detector_test {
namespace {

const Eigen::Vector3d kGravity(0.3, -0.2, 9.8);

/// Adds two seconds of samples at 250 Hz with noise from a start on; returns whether the body is at rest at the end.
bool is_at_rest(RestDetector& detector, double start_s, double noise_mps2) {
  const RandomStream noise(1, "test/rest");
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Eigen::Vector3d draw(noise.normal(i, 0), noise.normal(i, 1), noise.normal(i, 2));
    detector.add(from_seconds(start_s + 0.004 * static_cast<double>(i)), kGravity + noise_mps2 * draw);
  }
  return detector.is_at_rest();
}

TEST(RestDetector, NoiseOfHalfTheBoundIsRestAndOfTwiceTheBoundIsNot) {
  for (const double noise_mps2 : {0.05, 0.2}) {
    RestDetector detector({.window_s = 1.0, .max_std_mps2 = 0.1});
    EXPECT_EQ(is_at_rest(detector, 0.0, noise_mps2), noise_mps2 < 0.1);
  }
}

TEST(RestDetector, RestIsDetectedOneWindowAfterTheMotionEnds) {
  RestDetector detector({.window_s = 1.0, .max_std_mps2 = 0.1});
  EXPECT_FALSE(is_at_rest(detector, 0.0, 1.0));
  for (int i = 0; i < 200; ++i) detector.add(from_seconds(2.0 + 0.004 * i), kGravity);
  EXPECT_FALSE(detector.is_at_rest());
  for (int i = 200; i <= 252; ++i) detector.add(from_seconds(2.0 + 0.004 * i), kGravity);
  EXPECT_TRUE(detector.is_at_rest());
}

TEST(RestDetector, AWindowThatIsNotFullAndOneWithAGapAreNotRest) {
  RestDetector detector({.window_s = 1.0, .max_std_mps2 = 0.1});
  EXPECT_FALSE(detector.is_at_rest());
  detector.add(from_seconds(0.0), kGravity);
  EXPECT_FALSE(detector.is_at_rest());
  EXPECT_TRUE(is_at_rest(detector, 0.004, 0.01));
  detector.add(from_seconds(10.0), kGravity);
  EXPECT_FALSE(detector.is_at_rest());
}

}  // namespace
}  // namespace patrol::localize::rest_detector_test
