#include "score/pose/live_trajectory.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "score/pose/trajectory_error.h"
#include "tests/support/pose_near.h"

namespace patrol::score::live_trajectory_test {
namespace {

using namespace std::chrono_literals;
using test::Pose2Near;

constexpr double kExactTol = 1e-9;

/// Poses and the times at which they are received.
struct Stream {
  Trajectory poses;
  std::vector<Time> received;

  ReceivedPoses view() const { return {poses, received}; }
};

/// Poses every `period` from `begin` to `end`, each received `latency` after its stamp.
Stream stream(Time begin, Time end, Time period, const std::function<Pose2(double)>& pose_at_s, Time latency = 0ms) {
  Stream result;
  for (Time stamp = begin; stamp <= end; stamp += period) {
    result.poses.push_back({stamp, to_pose3(pose_at_s(to_seconds(stamp)))});
    result.received.push_back(stamp + latency);
  }
  return result;
}

/// Motion of 1 m/s along x.
Pose2 driven(double time_s) { return {time_s, 0.0, 0.0}; }
/// Odometry that counts a tenth too much.
Pose2 overcounted(double time_s) { return {1.1 * time_s, 0.0, 0.0}; }

const Trajectory kTruth = stream(0ms, 10s, 20ms, driven).poses;

// Correct until 4 s, then silent: odometry adds 0.1 m for each second. Over the 101 instants of 10 s the squares sum up
// to 0.01^2 n (n + 1) (2 n + 1) / 6 with n = 60.
TEST(LiveTrajectory, ASilentEstimatorIsScoredWithTheErrorThatOdometryAdds) {
  const Stream estimate = stream(0ms, 4s, 100ms, driven), odometry = stream(0ms, 10s, 20ms, overcounted);
  const TrajectoryError error = trajectory_error(live_trajectory(estimate.view(), odometry.view(), 10s), {}, kTruth);
  EXPECT_EQ(error.num_poses, 101U);
  EXPECT_NEAR(error.ate_max_m, 0.6, kExactTol);
  EXPECT_NEAR(error.ate_rmse_m, 0.01 * std::sqrt(60.0 * 61.0 * 121.0 / 6.0 / 101.0), kExactTol);
  EXPECT_NEAR(trajectory_error(estimate.poses, {}, kTruth).ate_max_m, 0.0, kExactTol) << "at its own stamps";
}

TEST(LiveTrajectory, WithoutOdometryTooTheLastPoseIsHeld) {
  const Stream estimate = stream(0ms, 4s, 100ms, driven), odometry = stream(0ms, 6s, 20ms, overcounted);
  const Trajectory live = live_trajectory(estimate.view(), odometry.view(), 10s);
  EXPECT_THAT(to_pose2(live.back().pose), Pose2Near((Pose2{4.0 + 1.1 * 2.0, 0.0, 0.0}), kExactTol, kExactTol));
  EXPECT_NEAR(trajectory_error(live, {}, kTruth).ate_max_m, 3.8, kExactTol);
  const Trajectory held = live_trajectory(estimate.view(), Stream().view(), 10s);
  EXPECT_NEAR(trajectory_error(held, {}, kTruth).ate_max_m, 6.0, kExactTol) << "no odometry at all";
}

TEST(LiveTrajectory, ComposesTheNewestCorrectionWithTheOdometry) {
  // Odometry starts at (5, 5) and faces along y of map; the second estimate corrects map -> odom by 0.3 m.
  const Stream odometry = stream(0ms, 2s, 20ms, [](double time_s) { return Pose2{5.0 + time_s, 5.0, 0.0}; });
  Stream estimate;
  estimate.poses = {{Time(0s), to_pose3({0.0, 0.0, std::numbers::pi / 2.0})},
                    {Time(1s), to_pose3({0.3, 1.0, std::numbers::pi / 2.0})}};
  estimate.received = {Time(0s), Time(1s)};
  const Trajectory live = live_trajectory(estimate.view(), odometry.view(), 2s);
  ASSERT_EQ(live.size(), 21U);
  EXPECT_THAT(to_pose2(live[9].pose), Pose2Near((Pose2{0.0, 0.9, std::numbers::pi / 2.0}), kExactTol, kExactTol));
  EXPECT_THAT(to_pose2(live[10].pose), Pose2Near((Pose2{0.3, 1.0, std::numbers::pi / 2.0}), kExactTol, kExactTol));
  EXPECT_THAT(to_pose2(live[20].pose), Pose2Near((Pose2{0.3, 2.0, std::numbers::pi / 2.0}), kExactTol, kExactTol));
}

TEST(LiveTrajectory, InstantsAreMultiplesOfATenthFromTheFirstPoseToTheEndWhateverTheStamps) {
  const Stream odometry = stream(0ms, 10s, 20ms, driven);
  for (const Time period : {37ms, 250ms, 3000ms}) {
    const Stream estimate = stream(1234ms, 9s, period, driven);
    const Trajectory live = live_trajectory(estimate.view(), odometry.view(), 10s);
    ASSERT_EQ(live.size(), 88U);
    EXPECT_EQ(live.front().stamp, Time(1300ms));
    EXPECT_EQ(live[1].stamp, Time(1400ms));
    EXPECT_EQ(live.back().stamp, Time(10s));
    EXPECT_NEAR(trajectory_error(live, {}, kTruth).ate_max_m, 0.0, kExactTol);
  }
  EXPECT_EQ(live_trajectory(stream(1234ms, 1240ms, 2ms, driven).view(), odometry.view(), 1250ms).size(), 1U);
  EXPECT_TRUE(live_trajectory(stream(11s, 12s, 1s, driven).view(), odometry.view(), 10s).empty());
}

// 0.5 s of latency: at an instant the newest estimate received within the following 0.2 s is 0.3 s old, and odometry
// adds 0.03 m to it. A latency of 0.2 s costs nothing.
TEST(LiveTrajectory, AnEstimateCountsFromWhenALookupWouldHaveReceivedIt) {
  const Stream odometry = stream(0ms, 10s, 20ms, overcounted);
  const auto error_with_latency = [&](Time latency) {
    const Stream estimate = stream(0ms, 10s, 100ms, driven, latency);
    return trajectory_error(live_trajectory(estimate.view(), odometry.view(), 10s), {}, kTruth);
  };
  EXPECT_NEAR(error_with_latency(200ms).ate_max_m, 0.0, kExactTol);
  EXPECT_NEAR(error_with_latency(500ms).ate_max_m, 0.03, kExactTol);
  EXPECT_EQ(error_with_latency(500ms).num_poses, 98U) << "from 0.3 s on";
}

TEST(LiveTrajectory, OdometryThatPausesIsHeldUntilALookupReceivesTheNextMessage) {
  Stream odometry = stream(0ms, 2s, 20ms, driven);
  const Stream later = stream(5s, 10s, 20ms, driven);
  odometry.poses.insert(odometry.poses.end(), later.poses.begin(), later.poses.end());
  odometry.received.insert(odometry.received.end(), later.received.begin(), later.received.end());
  const Trajectory live = live_odometry(odometry.view(), 10s);
  ASSERT_EQ(live.size(), 101U);
  EXPECT_NEAR(live[47].pose.position.x(), 2.0, kExactTol);
  EXPECT_NEAR(live[48].pose.position.x(), 4.8, kExactTol) << "interpolated, as by tf";
  EXPECT_NEAR(live[50].pose.position.x(), 5.0, kExactTol);
}

TEST(TimelyPoses, LeavesOutWhatIsReceivedTooLate) {
  Stream estimate = stream(0ms, 1s, 100ms, driven, 200ms);
  estimate.received[10] += 1ms;
  EXPECT_EQ(timely_poses(estimate.view()).size(), 10U);
}

}  // namespace
}  // namespace patrol::score::live_trajectory_test
