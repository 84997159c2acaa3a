#include "stack/stack.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "stack/make_stack.h"
#include "tests/stack/standing_quadruped.h"

namespace patrol::stack::stack_test {
namespace {

/// Asks for a goal from its fifth step on, and records what it is told.
class RecordingMission final : public Mission {
 public:
  RecordingMission(TaskTiming timing, std::vector<NavigationFeedback>& heard) : timing_(timing), heard_(heard) {}

  MissionOutput step(Time, const MissionInput& input) override {
    heard_.push_back(input.navigation);
    MissionOutput output;
    if (heard_.size() < 5) return output;
    output.task.motion = Motion::kNavigate;
    output.task.goal = NavigationGoal{.T_map_body = {}, .position_tolerance_m = 0.5, .yaw_tolerance_rad = 3.2};
    return output;
  }
  bool is_over() const override { return is_over_; }
  Event abort(Time now, EventKind kind, const std::string& text) override {
    is_over_ = true;
    return {.stamp = now, .kind = kind, .text = text};
  }
  TaskTiming timing() const override { return timing_; }
  bool starts_at_survey() const override { return true; }
  void serialize_state(StateArchive&) override {}

 private:
  TaskTiming timing_;
  std::vector<NavigationFeedback>& heard_;
  bool is_over_ = false;
};

/// Records when a mission hears that the first scan is still to come, and the last time.
class WaitingMission final : public Mission {
 public:
  explicit WaitingMission(std::vector<Time>& awaits) : awaits_(awaits) {}

  MissionOutput step(Time now, const MissionInput& input) override {
    if (input.awaits_first_scan) awaits_.push_back(now);
    return {};
  }
  bool is_over() const override { return false; }
  Event abort(Time now, EventKind kind, const std::string& text) override {
    return {.stamp = now, .kind = kind, .text = text};
  }
  TaskTiming timing() const override { return TaskTiming::kNow; }
  bool starts_at_survey() const override { return true; }
  void serialize_state(StateArchive&) override {}

 private:
  std::vector<Time>& awaits_;
};

Stack stack_of(const RobotDescription& robot, std::unique_ptr<Mission> mission, const StackSettings& settings = {}) {
  return Stack({.pose = PosePipeline(settings, robot, {}, {}, 1),
                .motion = MotionExecutor(settings, robot, {}, 1),
                .mission = std::move(mission),
                .instruments = InstrumentSet({}, 1.0),
                .sensor_monitor = SensorMonitor(settings.sensor_monitor),
                .dock = std::nullopt});
}

// The goal is reached where the robot stands. Either way the mission hears so one step after it has asked.
TEST(Stack, AMissionHearsOfItsTaskInTheNextStepWhateverItsTiming) {
  for (const TaskTiming timing : {TaskTiming::kNow, TaskTiming::kNext}) {
    const RobotDescription robot = quadruped_with_outline();
    std::vector<NavigationFeedback> heard;
    Stack stack = stack_of(robot, std::make_unique<RecordingMission>(timing, heard));
    stand(stack, robot, 2.0);
    ASSERT_GT(heard.size(), 7U);
    EXPECT_EQ(heard[4], NavigationFeedback::kDriving);
    EXPECT_EQ(heard[5], NavigationFeedback::kArrived);
  }
}

TEST(Stack, AMissionHearsThatTheFirstScanIsStillToComeUntilItGivesAPose) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<Time> awaits;
  Stack stack = stack_of(robot, std::make_unique<WaitingMission>(awaits));
  const std::vector<PoseEstimate> poses = all_of<PoseEstimate>(stand(stack, robot, 3.0));
  ASSERT_FALSE(awaits.empty());
  ASSERT_FALSE(poses.empty());
  EXPECT_LT(awaits.back(), poses.front().stamp);
  EXPECT_NEAR(to_seconds(awaits.back()), to_seconds(poses.front().stamp), 0.05);
}

// The settling time of 1 s, and 2 s for a scan.
TEST(Stack, AMissionHearsForThreeSecondsThatTheFirstScanIsStillToComeFromALidarWithoutScans) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<Time> awaits;
  Stack stack = stack_of(robot, std::make_unique<WaitingMission>(awaits));
  test::WalkingRobot walker(robot, test::stand_then_walk(1e9, {}), test::WalkingRobotSettings::without_noise(), 1);
  while (to_seconds(walker.now()) < 5.0) {
    walker.step();
    stack.handle(walker.imu(), walker.now());
    stack.handle(walker.joints(), walker.now());
    stack.handle(walker.contacts(), walker.now());
    stack.step(walker.now());
  }
  ASSERT_FALSE(awaits.empty());
  EXPECT_NEAR(to_seconds(awaits.back() - awaits.front()), 3.0, 0.05);
}

TEST(Stack, AFallEndsTheMissionOnce) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<NavigationFeedback> heard;
  Stack stack = stack_of(robot, std::make_unique<RecordingMission>(TaskTiming::kNow, heard));
  stack.handle_fall(from_seconds(1.0));
  stack.handle_fall(from_seconds(1.1));
  const std::vector<Event> events = all_of<Event>(stack.take_messages());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, EventKind::kFall);
  EXPECT_TRUE(stack.mission_is_over());
}

TEST(Stack, PublishesOdometryAndCommandsAtTheirPeriods) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<NavigationFeedback> heard;
  Stack stack = stack_of(robot, std::make_unique<RecordingMission>(TaskTiming::kNow, heard));
  const std::vector<StackMessage> messages = stand(stack, robot, 4.0);
  EXPECT_NEAR(static_cast<double>(all_of<OdometryEstimate>(messages).size()), 4.0 / 0.02, 5.0);
  EXPECT_NEAR(static_cast<double>(all_of<VelocityCommand>(messages).size()), 4.0 / 0.05, 3.0);
  EXPECT_NEAR(static_cast<double>(all_of<PoseEstimate>(messages).size()), 3.0 / 0.1,
              3.0);  // odometry settles for a second
}

/// Ends the mapping drive in its tenth step, and with it the mission.
class MappingMission final : public Mission {
 public:
  MissionOutput step(Time, const MissionInput&) override {
    MissionOutput output;
    if (++num_steps_ == 10) output.is_map_complete = is_over_ = true;
    return output;
  }
  bool is_over() const override { return is_over_; }
  Event abort(Time now, EventKind kind, const std::string& text) override {
    is_over_ = true;
    return {.stamp = now, .kind = kind, .text = text};
  }
  TaskTiming timing() const override { return TaskTiming::kNow; }
  bool starts_at_survey() const override { return true; }
  void serialize_state(StateArchive&) override {}

 private:
  int num_steps_ = 0;
  bool is_over_ = false;
};

TEST(Stack, AMappingDriveWithoutAUsedScanAbortsTheMissionWithTheNumberOfScansAndTheReason) {
  const auto event_text = [](const StackSettings& settings, const Pose3& T_body_lidar) {
    RobotDescription robot = quadruped_with_outline();
    robot.T_body_sensor["lidar"] = T_body_lidar;
    Stack stack({.pose = PosePipeline(settings, robot, {}, {.has_mapping_drive = true}, 1),
                 .motion = MotionExecutor(settings, robot, {}, 1),
                 .mission = std::make_unique<MappingMission>(),
                 .instruments = InstrumentSet({}, 1.0),
                 .sensor_monitor = SensorMonitor(settings.sensor_monitor),
                 .dock = std::nullopt});
    std::vector<StackMessage> messages = stand(stack, robot, 4.0);
    stack.finish(from_seconds(4.0));
    for (StackMessage& message : stack.take_messages()) messages.push_back(std::move(message));
    const std::vector<Event> events = all_of<Event>(messages);
    if (events.empty()) return std::string();
    EXPECT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].kind, EventKind::kMissionFailed);
    return events[0].text;
  };
  const Pose3 level{{0.0, 0.0, 0.2}, Eigen::Quaterniond::Identity()},
      tilted{{0.0, 0.0, 0.2}, quaternion_from_rpy(0.2, 0.0, 0.0)};
  StackSettings settings;
  settings.odometry_settling_time_s = 0.1;
  EXPECT_EQ(event_text(settings, level), "");
  settings.slam.graph.max_tilt_rad = 0.05;
  EXPECT_EQ(
      event_text(settings, tilted),
      "No map: of 5 scans of the sensor lidar none was used: 3 tilted by more than 0.05 rad, 2 without odometry.");
  settings.scan_leveling.max_range_m = 0.5;
  EXPECT_EQ(
      event_text(settings, level),
      "No map: of 5 scans of the sensor lidar none was used: 3 without a hit on anything but the robot, 2 without "
      "odometry.");
}

// 0.1 s of messages precede each step, as with a computing time of 0.1 s.
TEST(Stack, MessagesSinceTheLastStepAreNotInTheFuture) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<NavigationFeedback> heard;
  Stack stack = stack_of(robot, std::make_unique<RecordingMission>(TaskTiming::kNow, heard));
  const std::vector<StackMessage> messages = stand(stack, robot, 4.0, 20.0, from_seconds(0.1));
  EXPECT_GT(heard.size(), 20U);
  EXPECT_TRUE(std::ranges::none_of(all_of<Event>(messages),
                                   [](const Event& event) { return event.kind == EventKind::kSensorFault; }));
}

// Odometry is due at multiples of 20 ms, control at multiples of 50 ms.
TEST(Stack, HasSixStepsIn100ms) {
  const RobotDescription robot = quadruped_with_outline();
  std::vector<NavigationFeedback> heard;
  Stack stack = stack_of(robot, std::make_unique<RecordingMission>(TaskTiming::kNow, heard));
  const auto ms = [](int count) { return Time(std::chrono::milliseconds(count)); };
  EXPECT_LE(stack.next_step(), ms(0));
  stand(stack, robot, 2.0);
  Time now = ms(2000);
  std::vector<Time> steps;
  for (int i = 0; i < 6; ++i) {
    stack.step(now);
    now = stack.next_step();
    steps.push_back(now);
  }
  EXPECT_EQ(steps, (std::vector{ms(2020), ms(2040), ms(2050), ms(2060), ms(2080), ms(2100)}));
}

}  // namespace
}  // namespace patrol::stack::stack_test
