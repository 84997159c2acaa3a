#include "io/logs/run_log.h"

#include <map>

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/log_compare.h"
#include "io/mcap/mcap_reader.h"
#include "tests/io/sample_messages.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::run_log_test {
namespace {

using namespace std::chrono_literals;
using test::Pose2Near, test::Pose3Near, test::TemporaryFolder;

RobotDescription make_robot() {
  RobotDescription robot;
  robot.joint_names = {"FL_hip_joint", "FL_knee_joint"};
  robot.T_body_sensor["lidar"] = {{0.1, 0.0, 0.2}, quaternion_from_yaw(0.5)};
  return robot;
}

class RunLog : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.mcap";
};

/// All transforms of a topic.
std::vector<FrameTransform> transforms_of(const std::filesystem::path& file, const std::string& topic) {
  std::vector<FrameTransform> all;
  read_mcap(file,
            [&](const McapMessage& message) {
              for (const FrameTransform& one : decode<TransformSet>(message.cdr).transforms) all.push_back(one);
            },
            {.topics = {topic}});
  return all;
}

TEST_F(RunLog, BringsEveryMessageToItsHandlerAtItsTime) {
  RunLogWriter writer(file, make_robot());
  int written = 0;
  std::apply(
      [&](const auto&... message) {
        const auto write = [&](const auto& one) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(one)>, TransformSet>) writer.write(++written * 1s, one);
        };
        (write(message), ...);
      },
      test::all_samples());
  writer.close();

  std::map<int, int> calls;  // by the second of the log
  const auto count = [&](Time log_time, const auto& message) {
    EXPECT_EQ(message.stamp, test::kSampleStamp);
    ++calls[static_cast<int>(to_seconds(log_time))];
  };
  LogHandlers handlers;
  std::apply(
      [&](const auto&... message) {
        const auto handle = [&]<typename Message>(const Message&) {
          if constexpr (!std::is_same_v<Message, TransformSet>) handlers.on<Message>(count);
        };
        (handle(message), ...);
      },
      test::all_samples());
  EXPECT_TRUE(read_run_log(file, handlers));
  EXPECT_EQ(written, 36);
  EXPECT_EQ(calls.size(), 36U);
  for (const auto& [second, number] : calls) EXPECT_EQ(number, 1) << second;
}

TEST_F(RunLog, SensorMessagesGoToTheTopicOfTheirKind) {
  RunLogWriter writer(file, make_robot());
  writer.write(1s, test::sample_gas());
  writer.write(2s, test::sample_imu());
  writer.close();
  std::vector<std::string> topics;
  read_mcap(file, [&](const McapMessage& message) { topics.push_back(message.channel.topic); });
  EXPECT_EQ(topics, (std::vector<std::string>{"/tf_static", "/gas", "/imu/data"}));
}

TEST_F(RunLog, MessagesOfTwoTypesOnOneTopicKeepTheirTypeAndDefinition) {
  RunLogWriter writer(file, make_robot());
  const std::vector<std::pair<std::string, std::string>> types = {{"test_msgs/msg/A", "string text\n"},
                                                                  {"test_msgs/msg/B", "string text\n"},
                                                                  {"test_msgs/msg/A", "uint8[] data\n"}};
  for (const auto& [type, definition] : types) writer.write_foreign(1s, "/note", type, definition, "x");
  writer.close();
  std::vector<std::pair<std::string, std::string>> read;
  read_mcap(file,
            [&](const McapMessage& message) { read.emplace_back(message.channel.type, message.channel.definition); },
            {.topics = {"/note"}});
  EXPECT_EQ(read, types);
}

TEST_F(RunLog, ReadsFromOneTimeToAnother) {
  RunLogWriter writer(file, make_robot());
  for (int i = 0; i < 100; ++i) writer.write(i * 100ms, test::sample_imu());
  writer.close();
  int calls = 0;
  LogHandlers handlers;
  handlers.on<Imu>([&](Time, const Imu&) { ++calls; });
  read_run_log(file, handlers, 2s, 3s);
  EXPECT_EQ(calls, 11);
}

TEST_F(RunLog, WithoutHandlersItOnlyReportsWhetherTheLogIsComplete) {
  {
    RunLogWriter writer(file, make_robot());
    writer.write(1s, test::sample_imu());
  }
  EXPECT_FALSE(read_run_log(file, {}));
}

TEST_F(RunLog, JointsCarryTheRobotsNames) {
  RunLogWriter writer(file, make_robot());
  writer.write(1s, test::sample_joints());
  writer.close();
  read_mcap(file,
            [](const McapMessage& message) {
              EXPECT_NE(message.cdr.find("FL_hip_joint"), std::string_view::npos);
              EXPECT_NE(message.cdr.find("FL_knee_joint"), std::string_view::npos);
            },
            {.topics = {"/joint_states"}});
}

TEST_F(RunLog, MountsAreInTfStatic) {
  RunLogWriter(file, make_robot()).close();
  const auto mounts = transforms_of(file, "/tf_static");
  ASSERT_EQ(mounts.size(), 1U);
  EXPECT_EQ(mounts[0].parent, "base_link");
  EXPECT_EQ(mounts[0].child, "lidar");
  EXPECT_THAT(mounts[0].T_parent_child, Pose3Near(make_robot().T_body_sensor.at("lidar"), 0.0, 1e-7));
}

// map -> odom -> base_footprint -> base_link: the chain gives the estimate in the plane and the odometry's
// own tilt.
TEST_F(RunLog, FramesChainFromMapToBodyAtTheEstimatesStamp) {
  const Pose3 T_odom_body{{2.0, 1.0, 0.3}, quaternion_from_rpy(0.1, -0.2, 0.7)};
  const Pose2 T_map_body{5.0, -1.0, 1.2};
  RunLogWriter writer(file, make_robot());
  OdometryEstimate odometry{.stamp = 1s, .T_odom_body = T_odom_body, .twist = {}};
  writer.write(1s, odometry);
  odometry.stamp = 1100ms;
  odometry.T_odom_body = {{9.0, 9.0, 9.0}, quaternion_from_yaw(2.0)};
  writer.write(1100ms, odometry);
  writer.write(1200ms, PoseEstimate{.stamp = 1s, .T_map_body = T_map_body});  // comes later than what it is about
  writer.close();
  const auto frames = transforms_of(file, "/tf");
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[0].parent + " " + frames[0].child, "odom base_footprint");
  EXPECT_EQ(frames[1].parent + " " + frames[1].child, "base_footprint base_link");
  EXPECT_EQ(frames[4].parent + " " + frames[4].child, "map odom");
  EXPECT_THAT(frames[0].T_parent_child * frames[1].T_parent_child, Pose3Near(T_odom_body, 1e-12, 1e-7));
  EXPECT_NEAR((frames[0].T_parent_child.rotation * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12) << "level";
  EXPECT_THAT(to_pose2(frames[4].T_parent_child * frames[0].T_parent_child), Pose2Near(T_map_body, 1e-12, 1e-12));
}

/// A log of ten seconds; `change` may alter one scan.
template <typename Change>
void write_walk(const std::filesystem::path& file, const Change& change, int seconds = 10, bool close = true) {
  RunLogWriter writer(file, make_robot());
  for (int i = 0; i < 10 * seconds; ++i) {
    LaserScan scan = test::sample_scan();
    scan.stamp = i * 100ms;
    change(i, scan);
    writer.write(i * 100ms, test::sample_imu());
    writer.write(i * 100ms, scan);
  }
  if (close) writer.close();
}

constexpr auto kNoChange = [](int, LaserScan&) {};

TEST_F(RunLog, EqualLogsHaveNoDifference) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", kNoChange);
  EXPECT_FALSE(first_difference(file, folder / "again.mcap"));
}

TEST_F(RunLog, AChangedRangeIsNamedByTopicTimeAndField) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", [](int i, LaserScan& scan) {
    if (i >= 73) scan.ranges_m[3] = 1.25F;
  });
  const auto difference = first_difference(file, folder / "again.mcap");
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->topic, "/scan");
  EXPECT_EQ(difference->log_time, Time(7300ms));
  EXPECT_EQ(describe(*difference), "/scan at 7.300000000 s: ranges[3] is 1.25, was 1.5");
}

TEST_F(RunLog, ADifferenceInTheLastBitIsADifference) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", [](int i, LaserScan& scan) {
    if (i == 5) scan.ranges_m[0] = std::nextafter(scan.ranges_m[0], 10.0F);
  });
  EXPECT_TRUE(first_difference(file, folder / "again.mcap"));
  EXPECT_EQ(describe(*first_difference(file, folder / "again.mcap")),
            "/scan at 0.500000000 s: ranges[0] is 3.2500002, was 3.25");
}

TEST_F(RunLog, MoreBeamsAreNamedByTheListsSize) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", [](int i, LaserScan& scan) {
    if (i == 5) scan.ranges_m.push_back(1.0F), scan.angle_increment_rad = 0.1875;  // angle_max stays
  });
  const auto difference = first_difference(file, folder / "again.mcap");
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->what, "angle_increment is 0.1875, was 0.25");
}

TEST_F(RunLog, AShorterLogIsNamedByTheFirstMessageItLacks) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", kNoChange, 9);
  EXPECT_EQ(describe(*first_difference(file, folder / "again.mcap")),
            "/imu/data at 9.000000000 s: the other log ended before this message");
  EXPECT_EQ(describe(*first_difference(folder / "again.mcap", file)),
            "/imu/data at 9.000000000 s: the log ended before this message of the other");
}

TEST_F(RunLog, ACutOffLogIsNotEqualThoughItsMessagesAre) {
  write_walk(file, kNoChange);
  write_walk(folder / "again.mcap", kNoChange, 10, false);
  EXPECT_EQ(describe(*first_difference(file, folder / "again.mcap")),
            "identical messages, but the other log is truncated");
}

TEST_F(RunLog, TheSameMessageAtAnotherTimeOrOnAnotherTopicIsADifference) {
  const auto write = [&](const char* name, Time log_time, bool is_scan) {
    RunLogWriter writer(folder / name, make_robot());
    if (is_scan) writer.write(log_time, test::sample_scan());
    else writer.write(log_time, test::sample_imu());
    writer.close();
    return folder / name;
  };
  const auto log = write("log.mcap", 1s, true), late = write("late.mcap", 1s + 1ns, true),
             imu = write("imu.mcap", 1s, false);
  EXPECT_EQ(describe(*first_difference(log, late)),
            "/scan at 1.000000000 s: the other log has /scan at 1.000000001 s here");
  EXPECT_EQ(describe(*first_difference(log, imu)),
            "/scan at 1.000000000 s: the other log has /imu/data at 1.000000000 s here");
}

TEST_F(RunLog, AMissingLogIsRefusedByName) {
  write_walk(file, kNoChange);
  EXPECT_THROW(first_difference(file, folder / "missing.mcap"), InputError);
  EXPECT_THROW(read_run_log(folder / "missing.mcap", {}), InputError);
}

}  // namespace
}  // namespace patrol::io::run_log_test
