#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/run/run_loop.h"
#include "app/run/stack_port.h"
#include "core/grid.h"
#include "io/logs/run_log.h"
#include "io/ros/ros_messages.h"

namespace patrol::app {

/// Answers of a stack to a recorded log.
struct FedAnswers {
  RunOutcome outcome;
  std::vector<StampedPose> poses;       ///< poses on /pose, in order of publication
  std::vector<StampedPose> trajectory;  ///< newest trajectory on /trajectory; empty: none
  std::optional<OccupancyGrid> map;     ///< newest map on /map
};

/// Feeds a stack with the messages of a recorded log, lossless, and writes them with the answers to a log. The stack
/// has its turns at times of messages. Throws link::LinkError if the stack fails.
class LogFeeder {
 public:
  /// `mounts`: transforms of the sensors. `start`: time of the first messages.
  LogFeeder(std::unique_ptr<StackPort> stack, const std::filesystem::path& log_mcap, const io::TransformSet& mounts,
            Time start)
      : stack_(std::move(stack)), log_(log_mcap, mounts, {}, start) {}

  /// Begins the time of the next messages; a time before that of the last ones is theirs. The stack takes a turn with
  /// the earlier messages if it has asked for one by then.
  void advance(Time now);
  template <typename Message>
  void deliver(const Message& message) {
    give({.topic = io::kTopic<Message>, .log_time = now_, .cdr = log_.write(now_, message)});
  }
  /// Delivers a message of a channel that the stack has been told of.
  void deliver(const io::McapChannel& channel, std::string_view cdr);
  /// Gives the stack its last turn.
  void finish();
  /// Completes the log, also after a failure of the stack, and returns the answers. `outcome`: of the feeding.
  FedAnswers answers(RunOutcome outcome);

 private:
  void give(link::DeliveredMessage message);
  void take_turn();
  void record_turn(const StackTurnRecord& record);
  void publish(const std::vector<PublishedMessage>& messages);

  std::unique_ptr<StackPort> stack_;
  io::RunLogWriter log_;
  Time now_{};
  bool has_new_messages_ = false;  ///< whether a message has arrived since the last turn
  Time next_turn_{};
  FedAnswers fed_;
};

}  // namespace patrol::app
