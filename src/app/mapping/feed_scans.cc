#include "app/mapping/feed_scans.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/mapping/log_documents.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/overloaded.h"
#include "io/logs/run_log.h"
#include "link/link_error.h"

namespace patrol::app {
namespace {

// A log states the pose of the lidar for every scan, with rounding errors.
constexpr double kMountTolerance_m = 0.005;
const double kMountTolerance_rad = to_rad(0.5);

Time end_of(const LaserScan& scan) {
  const double last_beam = std::max(0.0, static_cast<double>(scan.ranges_m.size()) - 1.0);
  return scan.stamp + from_seconds(std::max(0.0, last_beam * scan.time_increment_s));
}

void check_mount(const Pose2& T_body_lidar, const RecordedScan& recorded, const std::string& file) {
  const Pose2 difference = T_body_lidar.inverse() * recorded.T_body_lidar;
  if (difference.position().norm() <= kMountTolerance_m && std::abs(difference.yaw) <= kMountTolerance_rad) return;
  throw InputError(
      fmt::format("{}: the lidar has another pose on the body at {:.3f} s: a stack is fed with one lidar: choose its "
                  "scans with --set log.scan_topic or log.carmen_laser",
                  file, to_seconds(recorded.scan.stamp)));
}

/// Stack that is fed with the scans of a log, from the first one on.
class ScanFeeder {
 public:
  ScanFeeder(const RecordedScan& first, std::unique_ptr<StackPort> stack, const std::filesystem::path& log_mcap)
      : stack_(std::move(stack)), log_(log_mcap, lidar_mount(first.T_body_lidar)) {}

  void add(const RecordedScan& recorded) {
    const Time now = std::max(turn_.now, end_of(recorded.scan));
    if (now > turn_.now) take_turn();
    turn_.now = now;
    deliver(RecordedOdometry{.stamp = recorded.scan.stamp, .T_odom_body = recorded.T_odom_body});
    if (const Time end = end_of(recorded.scan); end > recorded.scan.stamp)
      deliver(RecordedOdometry{.stamp = end, .T_odom_body = recorded.T_odom_body * recorded.T_begin_end});
    deliver(recorded.scan);
  }

  void finish() {
    const std::vector<PublishedMessage> messages = stack_->finish(turn_);
    record_turn({.turn = turn_.now, .delay = {}, .next_turn = turn_.now, .is_last = true, .mission_is_over = true});
    publish(messages);
  }

  /// Completes the log, also after a failure of the stack.
  FedScans result() {
    log_.close();
    fed_.outcome.seconds_by_stage = stack_->seconds_by_stage();
    return std::move(fed_);
  }

 private:
  template <typename Message>
  void deliver(const Message& message) {
    turn_.messages.push_back(
        {.topic = io::kTopic<Message>, .log_time = turn_.now, .cdr = log_.write(turn_.now, message)});
  }

  /// Lets the stack take a turn with the messages that wait, if it has asked for one by now.
  void take_turn() {
    if (turn_.messages.empty() || turn_.now < next_turn_) return;
    const StackAnswer answer = stack_->take_turn(turn_);
    turn_.messages.clear();
    next_turn_ = answer.next_turn;
    record_turn({.turn = turn_.now,
                 .delay = answer.delay,
                 .next_turn = answer.next_turn,
                 .is_last = false,
                 .mission_is_over = answer.mission_is_over});
    publish(answer.messages);
  }

  void record_turn(const StackTurnRecord& record) {
    if (stack_->records_turns()) log_.write(record.turn, record);
  }

  void publish(const std::vector<PublishedMessage>& messages) {
    for (const PublishedMessage& message : messages) {
      write_published(log_, turn_.now, message);
      if (!message.content) continue;
      std::visit(Overloaded{[](const auto&) {},
                            [&](const PoseEstimate& estimate) {
                              fed_.poses.push_back({estimate.stamp, to_pose3(estimate.T_map_body)});
                            },
                            [&](const TrajectoryEstimate& estimate) { fed_.trajectory = estimate.T_map_body; },
                            [&](const MapUpdate& update) { fed_.map = update.map; }},
                 *message.content);
    }
  }

  std::unique_ptr<StackPort> stack_;
  io::RunLogWriter log_;
  StackTurn turn_;
  Time next_turn_{};
  FedScans fed_;
};

}  // namespace

void check_scans(io::ScanLog& log, const std::string& file) {
  std::optional<Pose2> T_body_lidar;
  while (const std::optional<RecordedScan> recorded = log.next()) {
    if (!T_body_lidar) T_body_lidar = recorded->T_body_lidar;
    check_mount(*T_body_lidar, *recorded, file);
  }
}

FedScans feed_scans(io::ScanLog& log, const std::string& name, const MakeStack& make_stack,
                    const std::function<void()>& begin, const std::filesystem::path& log_mcap,
                    const InterruptGuard& guard) {
  const double wall_start_s = wall_seconds(), cpu_start_s = process_seconds();
  ProgressBar bar;
  std::optional<ScanFeeder> feeder;
  RunOutcome outcome;
  std::optional<Time> first_stamp;
  try {
    const bool is_whole = read_scans(log, name, guard, bar, [&](const RecordedScan& recorded) {
      if (!feeder) {
        std::unique_ptr<StackPort> stack = make_stack(lidar_mount(recorded.T_body_lidar));
        begin();
        feeder.emplace(recorded, std::move(stack), log_mcap);
        first_stamp = recorded.scan.stamp;
      }
      feeder->add(recorded);
      outcome.duration = recorded.scan.stamp - *first_stamp;
    });
    if (is_whole) {
      bar.show(fmt::format("{}  {} scans, last turn", name, log.summary().num_scans));
      feeder->finish();
    }
    if (!is_whole || guard.is_interrupted()) outcome.end = RunEnd::kInterrupted;
  } catch (const link::LinkError& error) {
    if (!feeder) throw;
    set_failure(outcome, error);
  }
  FedScans fed = feeder->result();
  outcome.seconds_by_stage = std::move(fed.outcome.seconds_by_stage);
  outcome.wall_s = wall_seconds() - wall_start_s;
  outcome.cpu_s = process_seconds() - cpu_start_s;
  fed.outcome = std::move(outcome);
  return fed;
}

}  // namespace patrol::app
