#include "sim/sensors/depth_camera.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/moments.h"

namespace patrol::sim::depth_camera_test {
namespace {

constexpr int kWidth = 80, kHeight = 60, kPixels = kWidth * kHeight;

/// Draws a formula.
class Painted : public DepthImager {
 public:
  using Depth = std::function<double(int u, int v)>;
  explicit Painted(Depth depth_m, double reflectivity) : depth_m_(std::move(depth_m)), reflectivity_(reflectivity) {}
  void draw(const BodyPoses&, const Pose3&, IdealDepthImage& image) override {
    image.depth_m.clear();
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) image.depth_m.push_back(static_cast<float>(depth_m_(u, v)));
    }
    image.reflectivity.assign(kPixels, static_cast<float>(reflectivity_));
  }

 private:
  Depth depth_m_;
  double reflectivity_;
};

DepthCameraSettings ideal() {
  DepthCameraSettings settings;
  settings.depth_noise_std_per_m = settings.baseline_m = settings.edge_dropout_probability =
      settings.dropout_probability = 0.0;
  settings.max_incidence_deg = 90.0;
  settings.max_range_10pct_m = 100.0;
  return settings;
}

DepthImage take(const DepthCameraSettings& settings, Painted::Depth depth_m, double reflectivity = 1.0,
                const DustSettings& dust = {}, std::uint64_t seed = 1) {
  DepthCamera camera(settings, dust, std::make_unique<Painted>(std::move(depth_m), reflectivity), seed);
  return camera.take({}, {}, from_seconds(1.5), 3);
}

Painted::Depth wall(double depth_m) {
  return [=](int, int) { return depth_m; };
}

int lost(const DepthImage& image) {
  int count = 0;
  for (const std::uint16_t depth_mm : image.depth_mm) count += depth_mm == 0;
  return count;
}

test::Moments errors_m(const DepthImage& image, double depth_m) {
  test::Moments errors;
  for (const std::uint16_t depth_mm : image.depth_mm) {
    if (depth_mm != 0) errors.add(0.001 * depth_mm - depth_m);
  }
  return errors;
}

double count_tolerance(double share, int n) { return 4.0 * std::sqrt(share * (1.0 - share) * n); }

TEST(DepthCamera, TheLensOf70DegreesHas80PixelsAt57PixelsOfFocalLength) {
  const DepthImage image = take(ideal(), wall(2.0));
  EXPECT_EQ(image.width, 80);
  EXPECT_EQ(image.height, 60);
  EXPECT_EQ(image.stamp, from_seconds(1.5));
  EXPECT_NEAR(image.fx_px, 40.0 / std::tan(35.0 * kDegree), 1e-12);
  EXPECT_EQ(image.fx_px, image.fy_px);
  EXPECT_EQ(image.cx_px, 39.5);  // between the two middle columns
  EXPECT_EQ(image.cy_px, 29.5);
  EXPECT_EQ(lost(image), 0);
  for (const std::uint16_t depth_mm : image.depth_mm) EXPECT_EQ(depth_mm, 2000);
}

TEST(DepthCamera, NoiseIs1CentimetreAt2MetresAnd4At4) {
  DepthCameraSettings settings = ideal();
  settings.depth_noise_std_per_m = 0.0026;
  for (const auto& [depth_m, std_m] : {std::pair(2.0, 0.0104), std::pair(4.0, 0.0416)}) {
    const test::Moments errors = errors_m(take(settings, wall(depth_m)), depth_m);
    EXPECT_EQ(errors.count, kPixels);
    EXPECT_NEAR(errors.mean(), 0.0, 4.0 * std_m / std::sqrt(kPixels));
    EXPECT_NEAR(errors.std(), std_m, 4.0 * std_m / std::sqrt(2.0 * kPixels));
  }
}

TEST(DepthCamera, NearerThan30CentimetresFartherThan8MetresAndNothingAtAllAreInvalid) {
  EXPECT_EQ(lost(take(ideal(), wall(0.29))), kPixels);
  EXPECT_EQ(lost(take(ideal(), wall(0.31))), 0);
  EXPECT_EQ(lost(take(ideal(), wall(7.99))), 0);
  EXPECT_EQ(lost(take(ideal(), wall(8.01))), kPixels);
  EXPECT_EQ(lost(take(ideal(), wall(std::numeric_limits<double>::infinity()))), kPixels);
}

TEST(DepthCamera, OnePixelIn100IsLostForNoReason) {
  DepthCameraSettings settings = ideal();
  settings.dropout_probability = 0.01;
  EXPECT_NEAR(lost(take(settings, wall(2.0))), 48.0, count_tolerance(0.01, kPixels));
}

/// A thing at 1 m before a wall at 4 m, from column 40 to 49.
double thing_before_wall(int u, int) { return u >= 40 && u < 50 ? 1.0 : 4.0; }

// The disparities differ by 57.1 px x 0.1 m x (1/1 - 1/4) / m = 4.28 px: four pixels left of the thing are hidden from
// the other imager.
TEST(DepthCamera, FourPixelsLeftOfAThingAreHiddenFromTheOtherImager) {
  DepthCameraSettings settings = ideal();
  settings.baseline_m = 0.1;
  const DepthImage image = take(settings, thing_before_wall);
  for (int u = 0; u < kWidth; ++u) {
    EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(20 * kWidth + u)] == 0, u >= 36 && u < 40) << u;
  }
}

TEST(DepthCamera, HalfThePixelsAlongEdgesAreLostAndNoneOfASlope) {
  DepthCameraSettings settings = ideal();
  settings.edge_dropout_probability = 0.5;
  const DepthImage image = take(settings, thing_before_wall);
  int lost_at_edges = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const bool is_lost = image.depth_mm[static_cast<std::size_t>(v * kWidth + u)] == 0;
      const bool is_edge = u == 39 || u == 40 || u == 49 || u == 50;
      EXPECT_TRUE(is_edge || !is_lost) << u << " " << v;
      lost_at_edges += is_lost;
    }
  }
  EXPECT_NEAR(lost_at_edges, 0.5 * 4 * kHeight, count_tolerance(0.5, 4 * kHeight));
}

/// The ground `height_m` below a level camera, with nothing above the horizon.
Painted::Depth ground(double height_m) {
  return [=](int, int v) {
    const double down = (v - 29.5) / make_lens({}).focal_px;
    return down > 0.0 ? height_m / down : std::numeric_limits<double>::infinity();
  };
}

// A row sees the ground at atan(focal / (v - 29.5)) from its normal in the middle column; 80 degrees are (v - 29.5)
// = 10.07.
TEST(DepthCamera, LevelGroundHasNoEdgesAndEndsWhereItIsMetAt80Degrees) {
  DepthCameraSettings settings = ideal();
  settings.edge_dropout_probability = 1.0;
  settings.max_incidence_deg = 80.0;
  settings.range_max_m = 60.0;
  const DepthImage image = take(settings, ground(0.4));
  const auto depth_mm = [&](int v) { return image.depth_mm[static_cast<std::size_t>(v * kWidth + 40)]; };
  EXPECT_EQ(depth_mm(39), 0);  // 9.5 rows below the horizon
  for (int v = 40; v < kHeight; ++v) EXPECT_NEAR(depth_mm(v), 1000.0 * 0.4 * image.fy_px / (v - 29.5), 0.51) << v;
}

// Squarely, 6 m on 10 % is 6 sqrt(0.02 / 0.1) = 2.68 m on 2 %. The corners of the picture are met at 42 degrees.
TEST(DepthCamera, BlackIsLostBeyond2_7MetresAndGreyIsNot) {
  DepthCameraSettings settings = ideal();
  settings.max_range_10pct_m = 6.0;
  EXPECT_EQ(lost(take(settings, wall(2.2), 0.02)), 0);
  EXPECT_EQ(lost(take(settings, wall(2.7), 0.02)), kPixels);
  EXPECT_EQ(lost(take(settings, wall(2.7), 0.1)), 0);
}

// With 10 m of visibility light falls by exp(-0.391 / m): 3 m look as dim as 3 exp(1.174) = 9.7 m.
TEST(DepthCamera, DustOf10MetresVisibilityTakesWhatLooksDimmerAndMakesNoiseTenTimesLarger) {
  DustSettings dust;
  dust.enabled = true;
  dust.visibility_m = 10.0;
  DepthCameraSettings settings = ideal();
  settings.max_range_10pct_m = 3.0;  // 9.49 m on white, squarely
  EXPECT_EQ(lost(take(settings, wall(3.0), 1.0, dust)), kPixels);
  EXPECT_LT(lost(take(settings, wall(2.8), 1.0, dust)), kPixels);
  EXPECT_EQ(lost(take(settings, wall(3.0), 1.0)), 0);

  settings = ideal();
  settings.depth_noise_std_per_m = 0.0026;
  const double std_m = 0.0026 * 9.0 * std::exp(2.0 * 3.0 * std::log(50.0) / 10.0);
  EXPECT_NEAR(errors_m(take(settings, wall(3.0), 1.0, dust), 3.0).std(), std_m, 4.0 * std_m / std::sqrt(2.0 * kPixels));
}

TEST(DepthCamera, WithoutNoiseTheSamePixelsAreLost) {
  DepthCameraSettings noisy, quiet;
  quiet.depth_noise_std_per_m = 0.0;
  const DepthImage a = take(noisy, thing_before_wall), b = take(quiet, thing_before_wall);
  EXPECT_GT(lost(a), 50);
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) EXPECT_EQ(a.depth_mm[pixel] == 0, b.depth_mm[pixel] == 0);
}

}  // namespace
}  // namespace patrol::sim::depth_camera_test
