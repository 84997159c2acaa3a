#include "app/mapping/feed_scans.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "link/link_error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::feed_scans_test {
namespace {

using ::testing::ElementsAre;

/// Log of given scans.
class GivenLog final : public io::ScanLog {
 public:
  explicit GivenLog(std::vector<RecordedScan> scans) : scans_(std::move(scans)) {}
  std::optional<RecordedScan> next() override {
    if (next_ == scans_.size()) return std::nullopt;
    return scans_[next_++];
  }
  double progress() const override { return 0.0; }

 private:
  std::vector<RecordedScan> scans_;
  std::size_t next_ = 0;
};

/// Turns of a stack, with their messages.
struct Given {
  std::vector<Time> turns;
  std::vector<std::vector<std::string>> topics;  ///< [turn]; the last turn is the end of the log
  std::vector<RecordedOdometry> odometry;
};

/// Stack that notes its turns and asks for the next one after `period`. Each turn publishes a pose, the end a
/// trajectory.
class NotingStack final : public StackPort {
 public:
  NotingStack(Given& given, Time period, int fails_at_turn)
      : given_(given), period_(period), fails_at_turn_(fails_at_turn) {}
  void deliver(link::DeliveredMessage message) override { messages_.push_back(std::move(message)); }
  void begin_turn(Time now) override { note(now); }
  StackAnswer end_turn() override {
    const Time now = given_.turns.back();
    if (static_cast<int>(given_.turns.size()) == fails_at_turn_)
      throw link::LinkError(link::LinkFault::kClosed, "the stack ended");
    const PoseEstimate pose{.stamp = now, .T_map_body = {1.0, 2.0, 0.5}};
    return {.messages = {message(pose)}, .next_turn = now + period_, .mission_is_over = false, .delay = {}};
  }
  std::vector<PublishedMessage> finish(Time now) override {
    note(now);
    return {message(TrajectoryEstimate{.stamp = now, .T_map_body = {{now, {}}}})};
  }
  bool records_turns() const override { return true; }
  std::map<std::string, double> seconds_by_stage() const override { return {}; }

 private:
  template <typename Message>
  static PublishedMessage message(const Message& content) {
    return {.content = content, .topic = io::kTopic<Message>, .type = {}, .definition = {}, .cdr = io::encode(content)};
  }
  void note(Time now) {
    given_.turns.push_back(now);
    given_.topics.emplace_back();
    for (const link::DeliveredMessage& delivered : std::exchange(messages_, {})) {
      given_.topics.back().push_back(delivered.topic);
      if (delivered.topic == io::kTopic<RecordedOdometry>)
        given_.odometry.push_back(io::decode<RecordedOdometry>(delivered.cdr));
    }
  }

  Given& given_;
  Time period_;
  int fails_at_turn_;
  std::vector<link::DeliveredMessage> messages_;
};

constexpr Time ms(int count) { return std::chrono::milliseconds(count); }

RecordedScan scan_at(Time stamp, double x_m = 0.0) {
  RecordedScan recorded;
  recorded.scan.stamp = stamp;
  recorded.scan.angle_increment_rad = 0.1;
  recorded.scan.ranges_m = {1.0F, 2.0F, 3.0F};
  recorded.T_odom_body = {x_m, 0.0, 0.0};
  recorded.T_body_lidar = {0.2, 0.0, 0.0};
  return recorded;
}

class FeedScans : public ::testing::Test {
 protected:
  FedAnswers feed(std::vector<RecordedScan> scans, Time period = Time{1}, int fails_at_turn = 0) {
    GivenLog log(std::move(scans));
    const InterruptGuard guard;
    return feed_scans(
        log, "log",
        [&](const io::TransformSet&) { return std::make_unique<NotingStack>(given_, period, fails_at_turn); },
        [&] { ++num_begins_; }, folder_.path() / "log.mcap", guard);
  }

  test::TemporaryFolder folder_;
  Given given_;
  int num_begins_ = 0;
};

TEST_F(FeedScans, TurnsAreAtTheEndsOfScansAndTheLastScanComesWithTheLastTurn) {
  const FedAnswers fed = feed({scan_at(ms(1000)), scan_at(ms(1100)), scan_at(ms(1200))});
  EXPECT_THAT(given_.turns, ElementsAre(ms(1000), ms(1100), ms(1200)));
  EXPECT_THAT(given_.topics[0], ElementsAre("/recorded_odometry", "/scan"));
  EXPECT_THAT(given_.topics[2], ElementsAre("/recorded_odometry", "/scan"));
  EXPECT_EQ(fed.outcome.end, RunEnd::kMissionOver);
  EXPECT_EQ(fed.outcome.duration, ms(200));
  EXPECT_EQ(fed.poses.size(), 2U);
  EXPECT_EQ(fed.trajectory.size(), 1U);
  EXPECT_EQ(num_begins_, 1);
}

TEST_F(FeedScans, AStackThatAsksForALaterTurnGetsAllScansThen) {
  feed({scan_at(ms(1000)), scan_at(ms(1100)), scan_at(ms(1200)), scan_at(ms(1300)), scan_at(ms(1400))}, ms(250));
  EXPECT_THAT(given_.turns, ElementsAre(ms(1000), ms(1300), ms(1400)));
  EXPECT_EQ(given_.topics[1].size(), 6U);
}

TEST_F(FeedScans, ScansWithOneStampComeInOneTurn) {
  feed({scan_at(ms(1000), 1.0), scan_at(ms(1000), 2.0), scan_at(ms(1100), 3.0)});
  EXPECT_THAT(given_.turns, ElementsAre(ms(1000), ms(1100)));
  EXPECT_THAT(given_.topics[0], ElementsAre("/recorded_odometry", "/scan", "/recorded_odometry", "/scan"));
}

TEST_F(FeedScans, AMovingScanHasOdometryAtItsFirstAndAtItsLastBeam) {
  RecordedScan moving = scan_at(ms(1000), 5.0);
  moving.scan.time_increment_s = 0.02;
  moving.T_begin_end = {0.1, 0.0, 0.25};
  feed({moving});
  EXPECT_THAT(given_.turns, ElementsAre(ms(1040)));
  ASSERT_EQ(given_.odometry.size(), 2U);
  EXPECT_EQ(given_.odometry[0].stamp, ms(1000));
  EXPECT_EQ(given_.odometry[1].stamp, ms(1040));
  EXPECT_DOUBLE_EQ(given_.odometry[1].T_odom_body.x, 5.1);
  EXPECT_NEAR(given_.odometry[1].T_odom_body.yaw, 0.25, 1e-15);
}

TEST_F(FeedScans, ALidarThatMovesBy6MmOnTheBodyIsRefused) {
  RecordedScan moved = scan_at(ms(1100));
  moved.T_body_lidar.x += 0.004;
  GivenLog still({scan_at(ms(1000)), moved});
  check_scans(still, "log");
  moved.T_body_lidar.x += 0.002;
  GivenLog moving({scan_at(ms(1000)), moved});
  EXPECT_THROW(check_scans(moving, "log"), InputError);
}

TEST_F(FeedScans, TheLogOfAFailedStackHasTheMessagesUpToTheFailure) {
  const FedAnswers fed = feed({scan_at(ms(1000)), scan_at(ms(1100)), scan_at(ms(1200))}, Time{1}, 2);
  EXPECT_EQ(fed.outcome.end, RunEnd::kStackFailed);
  EXPECT_EQ(fed.outcome.stack_failure, "the stack ended");
  EXPECT_EQ(fed.poses.size(), 1U);
  int num_scans = 0;
  io::LogHandlers handlers;
  handlers.on<LaserScan>([&](Time, const LaserScan&) { ++num_scans; });
  EXPECT_TRUE(io::read_run_log(folder_.path() / "log.mcap", handlers));
  EXPECT_EQ(num_scans, 2);
}

}  // namespace
}  // namespace patrol::app::feed_scans_test
