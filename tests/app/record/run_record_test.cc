#include "app/record/run_record.h"

#include <gtest/gtest.h>

#include "app/common/temporary_folder.h"
#include "io/logs/run_log.h"

namespace patrol::app::run_record_test {
namespace {

using namespace std::chrono_literals;

/// Run that starts at (2, 1) in world, the origin of map, and is registered twice.
RunRecord registered_run() {
  RunRecord record;
  record.T_map_body = {{from_seconds(1.0), to_pose3(Pose2{})}};
  record.T_world_body = {{from_seconds(1.0), to_pose3(Pose2{2.0, 1.0, 0.0})}};
  for (const double y_m : {1.1, 1.2}) {
    SiteRegistration registration;
    registration.stamp = from_seconds(y_m);
    registration.T_site_map = {2.0, y_m, 0.01};
    record.registrations.push_back(registration);
  }
  return record;
}

/// Record of a log that `write` has written after the first ground truth.
template <typename Write>
RunRecord record_of_log(const Write& write) {
  const TemporaryFolder folder("record");
  const std::filesystem::path file = folder.path() / "log.mcap";
  io::RunLogWriter log(file, io::TransformSet{});
  log.write(Time{}, GroundTruth{});
  write(log);
  log.close();
  return read_run_record(file);
}

TEST(ReadRunRecord, HasAFallIfTheLogHasAReportOfTheFirmware) {
  EXPECT_FALSE(record_of_log([](io::RunLogWriter&) {}).has_fall_report);
  EXPECT_TRUE(record_of_log([](io::RunLogWriter& log) { log.write(1s, FallReport{1s}); }).has_fall_report);
}

TEST(ReadRunRecord, HasConfidencesAndRegistrationsByTheirStampsNotByTheirReceipt) {
  const RunRecord record = record_of_log([](io::RunLogWriter& log) {
    for (const Time stamp : {1s, 3s, 2s}) {
      log.write(3s, LocalizationConfidence{.stamp = stamp, .confidence = 1.0});
      SiteRegistration registration;
      registration.stamp = stamp;
      log.write(3s, registration);
    }
  });
  ASSERT_EQ(record.confidences.size(), 3U);
  ASSERT_EQ(record.registrations.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(record.confidences[i].stamp, std::chrono::seconds(i + 1));
    EXPECT_EQ(record.registrations[i].stamp, std::chrono::seconds(i + 1));
  }
}

TEST(ReadRunRecord, CountsPathsWithPosesAndMarksEmptyPathsAndMaps) {
  const RunRecord record = record_of_log([](io::RunLogWriter& log) {
    log.write(1s, Path{.stamp = 1s, .T_map_body = {}});
    log.write(2s, Path{.stamp = 2s, .T_map_body = {{1.0, 0.0, 0.0}}});
    log.write(2s, MapUpdate{.stamp = 2s, .map = OccupancyGrid({.resolution_m = 0.05, .width = 0, .height = 0}, kFree)});
  });
  EXPECT_EQ(record.num_paths, 1U);
  EXPECT_TRUE(record.has_empty_path && record.has_empty_map);
  EXPECT_FALSE(record.has_map());
  const RunRecord silent = record_of_log([](io::RunLogWriter&) {});
  EXPECT_FALSE(silent.has_empty_path || silent.has_empty_map);
}

TEST(PoseOfMap, IsThatOfAGivenMapElseOfTheLastRegistrationElseOfTheStart) {
  RunRecord record = registered_run();
  EXPECT_EQ(pose_of_map(record, Pose2{5.0, 6.0, 0.3}).vector(), Eigen::Vector3d(5.0, 6.0, 0.3));
  EXPECT_EQ(pose_of_map(record, std::nullopt).vector(), Eigen::Vector3d(2.0, 1.2, 0.01));
  record.registrations.clear();
  EXPECT_EQ(pose_of_map(record, std::nullopt).vector(), Eigen::Vector3d(2.0, 1.0, 0.0));
}

TEST(PoseOfMap, IsTheFirstTruePoseOfAStackThatPublishesNoPose) {
  RunRecord record;
  record.T_world_body = {{Time{}, to_pose3({4.0, -1.0, 0.5}, 0.3)}, {from_seconds(1.0), to_pose3({5.0, -1.0, 0.5})}};
  const Pose2 pose = pose_of_map(record, std::nullopt);
  EXPECT_NEAR((pose.vector() - Eigen::Vector3d(4.0, -1.0, 0.5)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace patrol::app::run_record_test
