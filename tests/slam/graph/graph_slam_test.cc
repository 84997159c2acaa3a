#include "slam/graph/graph_slam.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/door_gallery.h"
#include "tests/slam/graph/office_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::graph_slam_test {
namespace {

struct MappedDrive {
  std::vector<test::DriveStep> drive;
  GraphSlam slam;
};

MappedDrive map_rounds(const test::RoomWorld& world, const std::vector<Eigen::Vector2d>& corners,
                       const test::DriveOptions& options, const GraphSlamSettings& settings = {},
                       std::uint64_t seed = 1) {
  MappedDrive mapped{.drive = test::drive_along(corners, options), .slam = GraphSlam(settings)};
  const RandomStream noise(seed, "test/graph");
  for (std::size_t k = 0; k < mapped.drive.size(); ++k) {
    const test::DriveStep& step = mapped.drive[k];
    mapped.slam.update(world.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, k), step.T_odom_body);
  }
  mapped.slam.finish();
  return mapped;
}

double rms_error_m(const MappedDrive& mapped) {
  const std::vector<Pose2> path = mapped.slam.path();
  double sum = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k)
    sum += (path[k].position() - (mapped.drive[0].T_world_body.inverse() * mapped.drive[k].T_world_body).position())
               .squaredNorm();
  return std::sqrt(sum / static_cast<double>(path.size()));
}

// 125 m and a bit of corridor; odometry alone turns by a radian and ends tens of meters off.
TEST(GraphSlam, ALapOfTheOfficeClosesToThreeCentimeters) {
  const MappedDrive mapped = map_rounds(test::make_office(), test::office_rounds(1), {});
  EXPECT_LT(rms_error_m(mapped), 0.03);
  EXPECT_GE(mapped.slam.loop_closure_statistics().closed, 1);
  EXPECT_EQ(mapped.slam.path().size(), mapped.drive.size());
}

TEST(GraphSlam, EveryLoopThatItClosesIsTrueToFiveCentimeters) {
  const MappedDrive mapped = map_rounds(test::make_office(), test::office_rounds(2), {});
  const std::vector<Pose2>& nodes = mapped.slam.graph().T_map_node;
  int loops = 0;
  for (const PoseGraphEdge& edge : mapped.slam.graph().edges) {
    if (edge.kind != PoseGraphEdge::Kind::kLoop) continue;
    ++loops;
    EXPECT_LT(edge_residual(edge, nodes).head<2>().norm(), 0.05);
  }
  EXPECT_GT(loops, 100);
  EXPECT_LT(rms_error_m(mapped), 0.03);
}

/// Mapped drive through the gallery of identical doors, and the submap matches that were accepted on it.
struct GalleryMapping {
  std::vector<test::DriveStep> drive;
  GraphSlam slam;
  int num_correct = 0;
  int num_shifted = 0;  ///< matches that are off by at least half the spacing of the doors

  double rms_error_m() const {
    const std::vector<Pose2> path = slam.path();
    double sum = 0.0;
    for (std::size_t k = 0; k < path.size(); ++k) sum += std::pow(error_m(path, k), 2);
    return std::sqrt(sum / static_cast<double>(path.size()));
  }
  double error_m(const std::vector<Pose2>& path, std::size_t k) const {
    return (path[k].position() - (drive[0].T_world_body.inverse() * drive[k].T_world_body).position()).norm();
  }
};

GalleryMapping map_doors(const test::RoomWorld& world, const std::vector<test::DriveStep>& drive, double spacing_m,
                         const GraphSlamSettings& settings, std::uint64_t seed) {
  GalleryMapping mapped{.drive = drive, .slam = GraphSlam(settings)};
  const RandomStream noise(seed, "test/graph");
  for (std::size_t k = 0; k < mapped.drive.size(); ++k) {
    const test::DriveStep& step = mapped.drive[k];
    mapped.slam.update(world.scan(step.T_world_body, step.stamp, test::DoorGallery::kLidar, noise, k),
                       step.T_odom_body);
  }
  // Before the refinement, loop edges are matches of whole submaps.
  const std::vector<std::size_t> scans = mapped.slam.node_scan_indices();
  for (const PoseGraphEdge& edge : mapped.slam.graph().edges) {
    if (edge.kind != PoseGraphEdge::Kind::kLoop) continue;
    const Pose2 T_from_to = mapped.drive[scans[static_cast<std::size_t>(edge.from)]].T_world_body.inverse() *
                            mapped.drive[scans[static_cast<std::size_t>(edge.to)]].T_world_body;
    const double error_m = (edge.T_from_to.position() - T_from_to.position()).norm();
    ++(error_m < 0.5 * spacing_m ? mapped.num_correct : mapped.num_shifted);
  }
  mapped.slam.finish();
  return mapped;
}

GalleryMapping map_gallery(const GraphSlamSettings& settings, std::uint64_t seed, double scale_mean = 0.0) {
  return map_doors(test::DoorGallery::world(), test::DoorGallery::drive(seed, scale_mean),
                   test::DoorGallery::kSpacing_m, settings, seed);
}

// The niches lie within the predicted drift of each other: every match between them is ambiguous. Those of the hall are
// not, and close the loop, also with odometry that is 8 % too long (seeds 4 and 5). The scale of the odometry along the
// bare walls remains as an error of the map.
TEST(GraphSlam, AmongIdenticalDoorsOnlyTheHallClosesLoopsAndEveryMatchOfDoorsIsRejectedAsAmbiguous) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const GalleryMapping mapped = map_gallery({}, seed, seed <= 3 ? 0.0 : 0.08);
    EXPECT_GE(mapped.num_correct, 2) << seed;
    EXPECT_EQ(mapped.num_shifted, 0) << seed;
    EXPECT_GE(mapped.slam.loop_closure_statistics().ambiguous, 15) << seed;
    const std::size_t back = test::DoorGallery::back_in_hall(mapped.drive);
    EXPECT_LT(mapped.error_m(mapped.slam.path(), back), 0.02) << seed;
    EXPECT_LT(mapped.rms_error_m(), 0.8) << seed;
  }
}

// The same drives with a matcher that takes the best match. The robust loss still keeps such matches out of the map; by
// least squares the map is bent by doors.
TEST(GraphSlam, WithoutTheCheckForASecondMatchDoorsAreTakenForOneAnotherInEveryDrive) {
  GraphSlamSettings naive;
  naive.loop_closure.max_second_best_ratio = 1.0;
  naive.loop_closure.max_second_best_inlier_fraction = 10.0;
  GraphSlamSettings least_squares = naive;
  least_squares.solver.robust_loop_closures = false;
  double robust_m = 0.0, least_squares_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const GalleryMapping robust = map_gallery(naive, seed), bent = map_gallery(least_squares, seed);
    EXPECT_GE(robust.num_shifted, 8) << seed;
    EXPECT_GE(bent.num_shifted, 8) << seed;
    robust_m += robust.rms_error_m() / 3.0;
    least_squares_m += bent.rms_error_m() / 3.0;
  }
  EXPECT_LT(robust_m, 0.5);
  EXPECT_GT(least_squares_m, 0.8);
}

// There and back in a corridor with a door every 2 to 6 m on both sides, 0.1 to 0.3 m deep, and no end in reach;
// odometry is 8 % too long. Matches are ambiguous by the drift of odometry, and the tracked pose decides them. Shallow
// doors hardly determine the distance: the map is up to 1.2 m off.
TEST(GraphSlam, InACorridorOfIdenticalDoorsWithoutAnEnd20DrivesCloseNineOfTenLoopsAndNoneThatIsOffByADoor) {
  int num_searched = 0, num_closed = 0;
  double max_error_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RandomStream draw(seed, "test/doors");
    const double y = 0.4 * (2.0 * draw.uniform(0) - 1.0), spacing_m = 2.0 + 4.0 * draw.uniform(1);
    const std::vector<test::DriveStep> drive =
        test::drive_along({{0.0, y}, {40.0, y}, {0.0, -y}},
                          {.speed_mps = 1.0, .odometry_scale = 0.08, .odometry_drift_rad_per_m = 0.002});
    const test::RoomWorld corridor =
        test::make_endless_corridor_of_doors(spacing_m, spacing_m * draw.uniform(2), 0.1 + 0.2 * draw.uniform(3));
    const GalleryMapping mapped = map_doors(corridor, drive, spacing_m, {}, seed);
    num_searched += mapped.slam.loop_closure_statistics().searched;
    num_closed += mapped.slam.loop_closure_statistics().closed;
    max_error_m = std::max(max_error_m, mapped.rms_error_m());
    EXPECT_EQ(mapped.num_shifted, 0) << seed;
  }
  EXPECT_GE(num_searched, 80);
  EXPECT_GE(num_closed, 0.9 * num_searched);
  EXPECT_LT(max_error_m, 1.3);
  RecordProperty("max_error_mm", static_cast<int>(1000.0 * max_error_m));
  RecordProperty("closed", num_closed);
  RecordProperty("searched", num_searched);
}

TEST(GraphSlam, TheSameScansGiveTheSamePathToTheBit) {
  const std::vector<Eigen::Vector2d> corners = {{8.0, 4.2}, {16.0, 4.2}, {8.0, 4.2}};
  const std::vector<Pose2> first = map_rounds(test::make_office(), corners, {}).slam.path(),
                           second = map_rounds(test::make_office(), corners, {}).slam.path();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(first[k].vector(), second[k].vector()) << k;
}

/// Anchors without delays, surveyed in map.
GraphSlamSettings with_known_anchors() {
  GraphSlamSettings settings;
  settings.ranges.common_std_m = 0.0;
  settings.ranges.anchor_delay_std_m = 1e-4;
  settings.positions.survey_position_std_m = 1e-3;
  settings.positions.survey_yaw_std_rad = 1e-4;
  return settings;
}

/// Along 40 m of smooth corridor with odometry 3 % too long; a radio at either end is heard ten times a second.
std::vector<SlamUpdate> follow_corridor(const GraphSlamSettings& settings, GraphSlam& slam) {
  test::RoomWorld corridor;
  corridor.add_wall(-100.0, -1.0, 200.0, -1.0).add_wall(-100.0, 1.0, 200.0, 1.0);
  const std::vector<UwbAnchor> anchors = {{.number = 1, .p_m = {-5.0, 0.8, 1.0}},
                                          {.number = 2, .p_m = {60.0, -0.8, 1.0}}};
  const RandomStream noise(1, "test/corridor"), radio(1, "test/radio");
  const Eigen::Vector3d antenna(0.2, 0.0, 0.6);
  std::vector<SlamUpdate> updates;
  for (std::uint64_t k = 0; k <= 400; ++k) {
    const Pose2 truth{0.1 * static_cast<double>(k), 0.0, 0.0}, T_odom_body{1.03 * truth.x, 0.0, 0.0};
    for (const UwbAnchor& anchor : anchors) {
      const double range_m = predict_uwb_range(anchor, truth, antenna, settings.ranges.calibration).range_m +
                             0.1 * radio.normal(k, static_cast<std::uint64_t>(anchor.number));
      slam.add({.anchor = anchor, .range_m = range_m, .T_odom_body = T_odom_body, .p_level_antenna = antenna});
    }
    updates.push_back(slam.update(
        corridor.scan(truth, from_seconds(0.1 * static_cast<double>(k)), test::kOldLidar, noise, k), T_odom_body));
  }
  return updates;
}

// Odometry alone is 1.2 m off at the end.
TEST(GraphSlam, AlongASmoothCorridorRangesConstrainItToTwelveCentimetersAndWithoutThemOdometryIsUsed) {
  for (const bool has_ranges : {true, false}) {
    GraphSlamSettings settings = with_known_anchors();
    settings.ranges.enabled = has_ranges;
    GraphSlam slam(settings);
    const std::vector<SlamUpdate> updates = follow_corridor(settings, slam);
    double worst = 0.0;
    for (std::size_t k = 0; k < updates.size(); ++k)
      worst = std::max(worst, std::abs(updates[k].T_map_body.x - 0.1 * static_cast<double>(k)));
    if (has_ranges) {
      EXPECT_LT(worst, 0.12);  // the kernel downweights noise of 1.5 standard deviations
      slam.finish();
      EXPECT_NEAR(slam.path().back().x, 40.0, 0.05);
    } else {
      EXPECT_GT(worst, 0.8);
    }
    EXPECT_LT(std::abs(updates.back().T_map_body.y), 0.02);
  }
}

TEST(GraphSlam, TheCovarianceGrowsAlongASmoothCorridorAndRangesKeepItSmall) {
  double along_std_m[2];
  for (const bool has_ranges : {true, false}) {
    GraphSlamSettings settings = with_known_anchors();
    settings.ranges.enabled = has_ranges;
    GraphSlam slam(settings);
    const Eigen::Matrix3d covariance = follow_corridor(settings, slam).back().covariance;
    along_std_m[has_ranges ? 1 : 0] = std::sqrt(covariance(0, 0));
    EXPECT_LT(std::sqrt(covariance(1, 1)), 0.005);
  }
  EXPECT_GT(along_std_m[0], 0.05);
  EXPECT_LT(along_std_m[1], 0.05);
}

// The scans determine the pose, hence the error of each radio.
TEST(GraphSlam, RangesAlongThePathShowWhichRadioMeasuresTwentyCentimetersTooLong) {
  test::RoomWorld room;
  room.add_box(-3.0, -2.0, 9.0, 4.0).add_wall(2.0, 4.0, 2.0, 2.5);
  GraphSlamSettings settings;
  settings.ranges.common_std_m = 0.0;
  GraphSlam slam(settings);
  const std::vector<UwbAnchor> anchors = {{.number = 1, .p_m = {-2.5, 3.5, 1.0}},
                                          {.number = 2, .p_m = {8.5, -1.5, 1.0}}};
  const Eigen::Vector3d antenna(0.2, 0.0, 0.6);
  EXPECT_TRUE(slam.mapped_ranges().empty());
  for (int k = 0; k <= 120; ++k) {
    const Pose2 truth{0.05 * k, 0.0, 0.0};
    for (const UwbAnchor& anchor : anchors) {
      const double range_m = predict_uwb_range(anchor, truth, antenna, settings.ranges.calibration).range_m;
      slam.add({.anchor = anchor,
                .range_m = anchor.number == 1 ? range_m + 0.2 : range_m,
                .T_odom_body = truth,
                .p_level_antenna = antenna});
    }
    LevelScan scan = room.scan(truth, {});
    scan.stamp = from_seconds(0.1 * k);
    slam.update(scan, truth);
  }
  slam.finish();
  EXPECT_GE(slam.mapped_ranges().size(), 8U);
  for (const MappedRange& mapped : slam.mapped_ranges()) {
    const UwbAnchor& anchor = anchors[static_cast<std::size_t>(mapped.anchor - 1)];
    const double predicted_m =
        predict_uwb_range(anchor, mapped.T_map_body, mapped.p_level_antenna, settings.ranges.calibration).range_m;
    EXPECT_NEAR(mapped.range_m - predicted_m, mapped.anchor == 1 ? 0.2 : 0.0, 0.03) << mapped.anchor;
    EXPECT_GE(mapped.count, 1);
  }
}

// As on a ramp between walls that lean: what is seen there is turned by 3 degrees, and odometry is right.
TEST(GraphSlam, ScansTiltedBy11DegreesAreNeitherMatchedNorIntegrated) {
  test::RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0);
  for (const double tilt_rad : {0.2, 0.0}) {
    GraphSlamSettings settings;
    settings.max_tilt_rad = 0.1;
    GraphSlam slam(settings);
    for (int i = 0; i < 12; ++i) slam.update(room.scan({}, {}), {});
    SlamUpdate update;
    for (int i = 1; i <= 6; ++i) {
      const Pose2 T_odom_body{0.1 * i, 0.0, 0.0};
      LevelScan scan = room.scan(T_odom_body * Pose2{0.0, 0.0, 0.05}, {});
      scan.tilt_rad = tilt_rad;
      update = slam.update(scan, T_odom_body);
    }
    EXPECT_EQ(update.match_score > 0.0, tilt_rad == 0.0);
    EXPECT_NEAR(update.T_map_body.yaw, tilt_rad > 0.0 ? 0.0 : 0.05, 0.015);
    EXPECT_NEAR(update.T_map_body.x, 0.6, 0.02);
  }
}

TEST(GraphSlam, BeforeAnyScanItHasNoPathAndAfterOneItIsAtTheOrigin) {
  GraphSlam slam({});
  EXPECT_TRUE(slam.path().empty());
  slam.finish();
  const Pose2 pose =
      slam.update(test::make_office().scan({8.0, 4.2, 0.0}, test::kOldLidar), {5.0, 5.0, 1.0}).T_map_body;
  EXPECT_THAT(pose, test::Pose2Near(Pose2{}, 1e-12, 1e-12));
  EXPECT_EQ(slam.path().size(), 1U);
}

}  // namespace
}  // namespace patrol::slam::graph_slam_test
