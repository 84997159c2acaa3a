#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "plan/perception/costmap.h"
#include "tests/support/depth_scene.h"
#include "tests/support/room_world.h"

// The costmap's layer of low obstacles, from images and pings to cells.
namespace patrol::plan::costmap_low_test {
namespace {

using test::DepthScene;

constexpr double kBodyHeight_m = 0.15;
constexpr double kStdPerM = 0.02;  // of the depth squared

Footprint make_robot() { return Footprint({{-0.5, -0.35}, {0.5, -0.35}, {0.5, 0.35}, {-0.5, 0.35}}, 2); }
Pose3 body_camera() { return {{0.445, 0.0, 0.225}, quaternion_from_rpy(0.0, 0.48, 0.0)}; }

/// A robot on tracks that looks at a scene, again and again.
class Looker {
 public:
  explicit Looker(const DepthScene& scene, const CostmapSettings& settings = {})
      : scene_(scene), costmap_(settings, make_robot(), {}), noise_(23, "test/depth") {}

  /// `pitch_rad` nose down; the body's origin stands `kBodyHeight_m` above the ground.
  Looker& look(const Pose2& T_map_body, int images, double pitch_rad = 0.0) {
    const Pose3 T_level_body{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.0, pitch_rad, 0.0)};
    const Pose3 T_level_camera = T_level_body * body_camera();
    const double z = scene_.ground_m(T_map_body.x, T_map_body.y) + kBodyHeight_m;
    const DepthImage exact = scene_.look(to_pose3(T_map_body, z) * T_level_camera);
    for (int i = 0; i < images; ++i) {
      const DepthImage image = test::with_noise(exact, kStdPerM, noise_, tick_++);
      const DepthPoints points = segment_obstacles({}, image, T_level_camera, kBodyHeight_m);
      most_ = std::max(most_, points.obstacles_m.size());
      costmap_.add_image(points, from_seconds(0.2 * static_cast<double>(tick_)), T_map_body);
    }
    return *this;
  }
  Costmap& costmap() { return costmap_; }
  std::size_t most_points() const { return most_; }
  bool has_obstacle_at(double x, double y) { return costmap_.is_low_obstacle(costmap_.geometry().cell_at({x, y})); }

 private:
  DepthScene scene_;
  Costmap costmap_;
  RandomStream noise_;
  std::uint64_t tick_ = 0;
  std::size_t most_ = 0;
};

/// A bar 6 cm high and deep and 1 m wide.
DepthScene make_bar(double x) {
  DepthScene scene;
  return scene.add_box({x, -0.5, 0.0}, {x + 0.06, 0.5, 0.06});
}

TEST(CostmapLow, ABarOfSixCentimetresAMetreAndAHalfAheadIsThereAfterThreeImages) {
  Looker looker(make_bar(1.52));
  looker.look({}, 3);
  EXPECT_EQ(looker.costmap().cost_at({1.55, 0.0}), kLethalCost);
  int num_seen = 0;
  for (double y = -0.45; y < 0.5; y += 0.1) num_seen += looker.has_obstacle_at(1.55, y);
  EXPECT_GE(num_seen, 3);
}

TEST(CostmapLow, FlatGroundGivesNoneInAThousandImages) {
  Looker looker{DepthScene()};
  looker.look({}, 1000);
  EXPECT_EQ(looker.costmap().num_low_obstacles(), 0u);
  RecordProperty("most_points_in_one_image", std::to_string(looker.most_points()));
}

// Ten metres towards and up a ramp of 15 degrees whose foot is at x = 2, an image every 5 cm.
TEST(CostmapLow, ARampOfFifteenDegreesAndItsFootAreNoWall) {
  const double slope = std::tan(15.0 * kDegree);
  Looker looker(DepthScene([=](double x, double) { return std::max(0.0, slope * (x - 2.0)); }));
  for (double x = -1.0; x < 6.0; x += 0.05) {
    const double on_ramp = std::clamp((x - 1.6) / 0.8, 0.0, 1.0);  // tracks of 0.8 m tilt as they climb on
    looker.look({x, 0.0, 0.0}, 1, -15.0 * kDegree * on_ramp);
  }
  EXPECT_EQ(looker.costmap().num_low_obstacles(), 0u);
}

TEST(CostmapLow, RubbleOfThreeCentimetresGivesNone) {
  Looker looker(DepthScene([](double x, double y) { return 0.03 * std::sin(9.0 * x) * std::cos(9.0 * y); }));
  for (double x = 0.0; x < 3.0; x += 0.1) looker.look({x, 0.0, 0.0}, 1);
  EXPECT_EQ(looker.costmap().num_low_obstacles(), 0u);
}

// Seen from 1.2 m, then driven up to until it is under the nose, out of the camera's sight.
TEST(CostmapLow, WhatIsUnderTheNoseIsStillKnown) {
  Looker looker(make_bar(1.52));
  for (double x = 0.0; x <= 0.9; x += 0.05) looker.look({x, 0.0, 0.0}, 1);
  looker.look({0.9, 0.0, 0.0}, 20);
  EXPECT_EQ(looker.costmap().cost_at({1.55, 0.0}), kLethalCost);
  EXPECT_LT(looker.costmap().clearance_m({0.95, 0.0, 0.0}), 0.1);
}

TEST(CostmapLow, ATakenAwayBarIsForgottenWhenTheGroundIsSeen) {
  Looker looker(make_bar(1.22));
  looker.look({}, 5);
  ASSERT_GT(looker.costmap().num_low_obstacles(), 0u);
  Costmap costmap = looker.costmap();
  const DepthImage empty = DepthScene().look(to_pose3({}, kBodyHeight_m) * body_camera());
  for (int i = 0; i < 6; ++i) {
    costmap.add_image(segment_obstacles({}, empty, body_camera(), kBodyHeight_m), from_seconds(2.0 + 0.2 * i), {});
  }
  EXPECT_EQ(costmap.num_low_obstacles(), 0u);
}

TEST(CostmapLow, TheLayerSurvivesTheCostmapsGrowth) {
  Looker looker(make_bar(1.52));
  looker.look({}, 5);
  const std::size_t before = looker.costmap().num_low_obstacles();
  looker.costmap().include({-40.0, 30.0}, 1.0);
  EXPECT_EQ(looker.costmap().num_low_obstacles(), before);
  EXPECT_EQ(looker.costmap().cost_at({1.55, 0.0}), kLethalCost);
}

SonarCone cone_to(double range_m, double azimuth_rad = 0.0) {
  const UltrasonicRange ping{.stamp = {},
                             .transducer = 0,
                             .field_of_view_rad = 0.6,
                             .range_min_m = 0.2,
                             .range_max_m = 4.0,
                             .range_m = static_cast<float>(range_m)};
  return inverse_sonar_model({}, ping, {{0.45, 0.0, 0.1}, quaternion_from_yaw(azimuth_rad)}, kBodyHeight_m, 0.1);
}

TEST(CostmapLow, TwoPingsMarkAnArcAndTwoLongerOnesFreeIt) {
  Costmap costmap({}, make_robot(), {});
  costmap.add_ping(cone_to(0.5), from_seconds(0.0), {});
  EXPECT_EQ(costmap.num_low_obstacles(), 0u);
  costmap.add_ping(cone_to(0.5), from_seconds(0.2), {});
  EXPECT_EQ(costmap.cost_at({0.95, 0.0}), kLethalCost);
  costmap.add_ping(cone_to(3.0), from_seconds(0.4), {});
  costmap.add_ping(cone_to(3.0), from_seconds(0.6), {});
  EXPECT_EQ(costmap.num_low_obstacles(), 0u);
}

// Without images: pings in another direction end the persistence, too.
TEST(CostmapLow, EvidenceOfSonarExpiresWithoutImages) {
  CostmapSettings settings;
  settings.low.sonar_persistence_s = 15.0;
  Costmap costmap(settings, make_robot(), {});
  for (const double time_s : {0.0, 0.2}) costmap.add_ping(cone_to(0.5), from_seconds(time_s), {});
  ASSERT_GT(costmap.num_low_obstacles(), 0u);
  costmap.add_ping(cone_to(3.0, M_PI / 2.0), from_seconds(15.1), {});
  EXPECT_EQ(costmap.cost_at({0.95, 0.0}), kLethalCost);
  costmap.add_ping(cone_to(3.0, M_PI / 2.0), from_seconds(15.3), {});
  EXPECT_EQ(costmap.num_low_obstacles(), 0u);
  EXPECT_LT(costmap.cost_at({0.95, 0.0}), kLethalCost);
}

TEST(CostmapLow, AnEchoOfWhatTheLidarSeesMarksNothing) {
  Costmap costmap({}, make_robot(), {});
  test::RoomWorld wall;
  wall.add_wall(0.97, -1.0, 0.97, 1.0);
  costmap.add_scan(wall.scan({}, {.beams = 720}), {});
  for (int i = 0; i < 5; ++i) costmap.add_ping(cone_to(0.5), from_seconds(0.1 * i), {});
  EXPECT_EQ(costmap.num_low_obstacles(), 0u);
}

}  // namespace
}  // namespace patrol::plan::costmap_low_test
