#include "io/logs/mcap_scan_log.h"

#include "tests/io/logs/mcap_scans.h"

namespace patrol::io::mcap_scan_log_test {
namespace {

TEST_F(McapScans, OdometryIsInterpolatedToTheScansStamp) {
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1300ms, scan_at(1250ms));
  writer.write("/odom", 2s, odometry_at(2s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 1250ms);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.25, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[0].scan.ranges_m, ElementsAre(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(result.scans[0].scan.angle_min_rad, -0.5);
  EXPECT_THAT(result.summary.assumed, ElementsAre(Pair(HasSubstr("body origin"), 1U)));
}

TEST_F(McapScans, WhereBeamsHaveTimesTheMotionFromTheFirstToTheLastIsGiven) {
  LaserScan scan = scan_at(1250ms);
  scan.time_increment_s = 0.1;  // three beams: 0.2 s at 1 m/s
  LaserScan last = scan_at(1900ms);
  last.time_increment_s = 0.1;  // odometry ends before it does
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1300ms, scan);
  writer.write("/scan", 1950ms, last);
  writer.write("/odom", 2s, odometry_at(2s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.25, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[0].T_begin_end, Pose2Near(Pose2{0.2, 0.0, 0.0}, 1e-6, 1e-6));  // float32 in the message
  EXPECT_THAT(result.scans[1].T_begin_end, Pose2Near(Pose2{}, kExactTol, kExactTol));
}

TEST_F(McapScans, WithoutAnOdometryTopicTfIsTakenOverItsFramesBetween) {
  for (const Time t : {1s, 2s}) {
    writer.write(
        "/tf", t,
        TransformSet{{placed("odom", "base_footprint", {{to_seconds(t), 0.0, 0.0}, quaternion_from_yaw(0.5)}, t),
                      placed("base_footprint", "base_link", {{0.0, 0.0, 0.4}, Eigen::Quaterniond::Identity()}, t)}});
    if (t == 1s) writer.write("/scan", 1500ms, scan_at(1500ms));
  }
  writer.close();
  EXPECT_THAT(read().scans.at(0).T_odom_body, Pose2Near(Pose2{1.5, 0.0, 0.5}, kExactTol, kExactTol));
}

TEST_F(McapScans, WithoutBaseLinkTfLeadsToBaseFootprint) {
  writer.write("/tf_static", 0s, TransformSet{{placed("base_footprint", "lidar", {{0.3, 0.1, 0.5}})}});
  for (const Time t : {1s, 2s}) {
    writer.write("/tf", t,
                 TransformSet{{placed("odom", "base_footprint",
                                      {{to_seconds(t), 0.0, 0.0}, Eigen::Quaterniond::Identity()}, t)}});
    if (t == 1s) writer.write("/scan", 1500ms, scan_at(1500ms));
  }
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_THAT(result.scans[0].T_odom_body, Pose2Near(Pose2{1.5, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(result.scans[0].T_body_lidar, Pose2Near(Pose2{0.3, 0.1, 0.0}, kExactTol, kExactTol));
}

TEST_F(McapScans, FramesOfTfMayHaveANamespace) {
  for (const Time t : {1s, 2s}) {
    writer.write("/tf", t,
                 TransformSet{{placed("robot1/odom", "robot1/base_link",
                                      {{to_seconds(t), 0.0, 0.0}, Eigen::Quaterniond::Identity()}, t)}});
    if (t == 1s) writer.write("/robot1/scan", 1500ms, scan_at(1500ms));
  }
  writer.close();
  EXPECT_THAT(read().scans.at(0).T_odom_body, Pose2Near(Pose2{1.5, 0.0, 0.0}, kExactTol, kExactTol));
}

TEST_F(McapScans, OdometryInWorldIsNamedWithItsTopic) {
  for (const Time t : {0s, 1s}) {
    writer.write("/odom", t, GroundTruth{.stamp = t, .T_world_body = {}, .twist = {}});
    if (t == 0s) writer.write("/scan", 500ms, scan_at(500ms));
  }
  writer.close();
  EXPECT_THAT(complaint(), HasSubstr("the odometry on /odom is in the frame world, not in odom: can be selected: "
                                     "log.odometry_topic=/odom"));
}

TEST_F(McapScans, TheFirstSourceIsKept) {
  writer.write("/tf", 0s, TransformSet{{placed("odom", "base_link", {}, 0s)}});
  writer.write("/scan", 500ms, scan_at(500ms));
  writer.write("/tf", 1s, TransformSet{{placed("odom", "base_link", {}, 1s)}});
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1500ms, scan_at(1500ms));
  writer.write("/tf", 2s, TransformSet{{placed("odom", "base_link", {}, 2s)}});
  writer.write("/odom", 2s, odometry_at(2s));
  writer.write("/scan", 2500ms, scan_at(2500ms));
  writer.write("/tf", 3s, TransformSet{{placed("odom", "base_link", {}, 3s)}});
  writer.write("/odom", 3s, odometry_at(3s));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 3U);
  for (const RecordedScan& scan : result.scans) EXPECT_EQ(scan.T_odom_body.x, 0.0) << "tf's, not the topic's";
}

TEST_F(McapScans, TheLidarPoseIsThePlanarPartOfTfStatic) {
  writer.write(
      "/tf_static", 0s,
      TransformSet{{placed("base_link", "plate", {{0.1, 0.0, 0.5}, quaternion_from_yaw(std::numbers::pi / 2.0)}),
                    placed("plate", "lidar", {{0.2, 0.0, 0.0}, Eigen::Quaterniond::Identity()})}});
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 1s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const Read result = read();
  EXPECT_THAT(result.scans.at(0).T_body_lidar,
              Pose2Near(Pose2{0.1, 0.2, std::numbers::pi / 2.0}, kExactTol, kExactTol));
  EXPECT_TRUE(result.summary.assumed.empty());
}

TEST_F(McapScans, AStaticTransformAtTheEndHoldsFromTheStart) {
  for (int second = 0; second <= 2; ++second) writer.write("/odom", second * 1s, odometry_at(second * 1s));
  for (int tenth = 0; tenth < 20; ++tenth) writer.write("/scan", tenth * 100ms, scan_at(tenth * 100ms));
  writer.write("/tf_static", 2s, TransformSet{{placed("base_link", "lidar", {{0.3, 0.1, 0.5}})}});
  writer.write("/tf_static", 2s, TransformSet{{placed("base_link", "lidar", {{0.7, 0.1, 0.5}})}});
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 20U);
  EXPECT_THAT(result.scans.front().T_body_lidar, Pose2Near(Pose2{0.3, 0.1, 0.0}, kExactTol, kExactTol));
  EXPECT_TRUE(result.summary.assumed.empty());
}

TEST_F(McapScans, ScansBeforeAllOdometryInTheFileAreReadByLogTime) {
  for (int tenth = 0; tenth < 600; ++tenth) writer.write("/scan", tenth * 100ms, scan_at(tenth * 100ms));
  for (int second = 0; second <= 60; ++second) writer.write("/odom", second * 1s, odometry_at(second * 1s));
  writer.close();
  EXPECT_EQ(read().scans.size(), 600U);
}

TEST_F(McapScans, ALidarUpsideDownRotatesTheOppositeWay) {
  writer.write("/tf_static", 0s,
               TransformSet{{placed("base_link", "lidar",
                                    {{0.1, 0.0, 0.5}, quaternion_from_rpy(std::numbers::pi, 0.0, 0.25)})}});
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 1s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const RecordedScan scan = read().scans.at(0);
  EXPECT_THAT(scan.T_body_lidar, Pose2Near(Pose2{0.1, 0.0, 0.25}, kExactTol, kExactTol));
  EXPECT_EQ(scan.scan.angle_min_rad, 0.5);
  EXPECT_EQ(scan.scan.angle_increment_rad, -0.25);
}

TEST_F(McapScans, TheGroundTruthIsNotTheRobotsOdometry) {
  for (const Time t : {0s, 1s}) {
    writer.write(
        "/ground_truth/odom", t,
        GroundTruth{.stamp = t, .T_world_body = {{99.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, .twist = {}});
    writer.write("/odom", t, odometry_at(t));
    if (t == 0s) writer.write("/scan", t, scan_at(500ms));
  }
  writer.close();
  const Read result = read();
  EXPECT_EQ(result.scans.at(0).T_odom_body.x, 0.5);
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("/ground_truth/odom", 2U)));
}

TEST_F(McapScans, TopicsCanBeAskedFor) {
  for (const Time t : {0s, 1s}) {
    writer.write("/odom", t, odometry_at(t));
    writer.write("/visual_odom", t, odometry_at(t, 10.0));
    if (t == 0s) writer.write("/front/scan", t, scan_at(250ms));
    if (t == 0s) writer.write("/rear/scan", t, scan_at(500ms));
  }
  writer.close();
  EXPECT_EQ(read().scans.at(0).scan.stamp, 250ms) << "the first, unless asked otherwise";
  ScanLogOptions options;
  options.scan_topic = "/rear/scan";
  options.odometry_topic = "/visual_odom";
  const Read result = read(options);
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 500ms);
  EXPECT_EQ(result.scans[0].T_odom_body.x, 10.5);
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("/front/scan", 1U), Pair("/odom", 2U)));
}

TEST_F(McapScans, ScansOfSeveralLidarsEachHaveTheirMount) {
  writer.write("/tf_static", 0s,
               TransformSet{{placed("base_link", "lidar", {{0.3, 0.0, 0.2}, Eigen::Quaterniond::Identity()})}});
  for (const Time t : {0s, 1s}) {
    writer.write("/odom", t, odometry_at(t));
    if (t == 0s) writer.write("/front/scan", t, scan_at(250ms));
    if (t == 0s) writer.write("/rear/scan", t, scan_at(500ms));
    if (t == 0s) writer.write("/top/scan", t, scan_at(600ms));
  }
  writer.close();
  ScanLogOptions options;
  options.scan_topic = "/front/scan, /rear/scan";
  const Read result = read(options);
  ASSERT_EQ(result.scans.size(), 2U);
  EXPECT_EQ(result.scans[0].scan.stamp, 250ms);
  EXPECT_EQ(result.scans[1].scan.stamp, 500ms);
  EXPECT_THAT(result.summary.ignored, ElementsAre(Pair("/top/scan", 1U)));
}

/// Three points at 2 m ahead of a lidar that is pitched down by 0.5 rad: one at its height, one 1 m above, one below.
PointCloud wall_ahead_of_a_tilted_lidar(Time stamp) {
  PointCloud cloud{.stamp = stamp, .points = {}};
  for (const double height_m : {0.0, 1.0, -1.0}) {
    cloud.points.push_back(test::cloud_point_at(quaternion_from_rpy(0.0, 0.5, 0.0).conjugate() *
                                                Eigen::Vector3d(2.0 + 0.1 * height_m, 0.0, height_m)));
  }
  return cloud;
}

TEST_F(McapScans, ASelectedPointCloudIsSlicedAtTheHeightOfTheLidar) {
  writer.write("/tf_static", 0s,
               TransformSet{{placed("base_link", "lidar3d", {{0.1, 0.0, 0.5}, quaternion_from_rpy(0.0, 0.5, 0.25)})}});
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/points", 500ms, wall_ahead_of_a_tilted_lidar(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  EXPECT_THAT(complaint(), EndsWith("point clouds can be selected: log.scan_topic=/points"));
  ScanLogOptions options;
  options.scan_topic = "/cloud";
  EXPECT_THAT(complaint(options), HasSubstr("contains no scan on /cloud (log.scan_topic)"));
  options.scan_topic = "/points";
  options.cloud = {.min_height_m = 0.5, .max_height_m = 0.5};
  EXPECT_THROW(read(options), InputError);
  options.cloud = {};
  options.detect_no_return = false;  // the file has one range only
  const RecordedScan recorded = read(options).scans.at(0);
  EXPECT_THAT(recorded.T_body_lidar, Pose2Near(Pose2{0.1, 0.0, 0.25}, kExactTol, kExactTol));
  EXPECT_NEAR(recorded.scan.ranges_m[360], 2.0F, 1e-5F);
  EXPECT_EQ(std::count_if(recorded.scan.ranges_m.begin(), recorded.scan.ranges_m.end(),
                          [](float range_m) { return std::isfinite(range_m); }),
            1);
}

TEST_F(McapScans, ScansOutsideTheOdometrysTimeAreSkippedAndCounted) {
  writer.write("/scan", 0s, scan_at(500ms));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.write("/scan", 1s, scan_at(1500ms));
  writer.write("/odom", 2s, odometry_at(2s));
  writer.write("/scan", 2s, scan_at(2500ms));
  writer.close();
  const Read result = read();
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_EQ(result.scans[0].scan.stamp, 1500ms);
  EXPECT_THAT(result.summary.skipped, ElementsAre(Pair("scans without odometry", 2U)));
  EXPECT_THAT(result.summary.warnings.at(0), EndsWith("log.mcap: no odometry at the stamp of the scan, 0.500000000 s"));
}

TEST_F(McapScans, RangesAreTidiedAsRep117Asks) {
  writer.write("/odom", 0s, odometry_at(0s));
  writer.write("/scan", 0s, scan_at(500ms, {29.9F, 30.0F, 65.5F, kInfinity, 0.49F, 0.0F, -1.0F, NAN, -kInfinity}));
  writer.write("/odom", 1s, odometry_at(1s));
  writer.close();
  const std::vector<float> ranges = read().scans.at(0).scan.ranges_m;
  EXPECT_EQ(ranges[0], 29.9F);
  for (const std::size_t beam : {1U, 2U, 3U}) EXPECT_EQ(ranges[beam], kInfinity) << beam;
  for (const std::size_t beam : {4U, 8U}) EXPECT_EQ(ranges[beam], -kInfinity) << beam;
  for (const std::size_t beam : {5U, 6U, 7U}) EXPECT_TRUE(std::isnan(ranges[beam])) << beam;
}

TEST_F(McapScans, PatrolsOwnRunLogsAreRead) {
  RobotDescription robot;
  robot.T_body_sensor["lidar"] = {{0.2, 0.0, 0.1}, quaternion_from_yaw(0.1)};
  const std::filesystem::path run_log = folder / "run.mcap";
  RunLogWriter run(run_log, robot);
  for (int i = 0; i < 100; ++i) {
    const Time now = i * 100ms;
    run.write(now, GroundTruth{
                       .stamp = now, .T_world_body = {{50.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}, .twist = {}});
    run.write(now, odometry_at(now));
    run.write(now, scan_at(now + 50ms));
  }
  run.close();
  const std::unique_ptr<ScanLog> log = open_scan_log(run_log);
  int count = 0;
  while (const auto scan = log->next()) {
    EXPECT_EQ(scan->scan.stamp, count * 100ms + 50ms);
    EXPECT_THAT(scan->T_odom_body, Pose2Near(Pose2{0.1 * count + 0.05, 0.0, 0.0}, kExactTol, kExactTol));
    EXPECT_THAT(scan->T_body_lidar, Pose2Near(Pose2{0.2, 0.0, 0.1}, kExactTol, kExactTol));
    ++count;
  }
  EXPECT_EQ(count, 99) << "the last has no odometry after it";
}

}  // namespace
}  // namespace patrol::io::mcap_scan_log_test
