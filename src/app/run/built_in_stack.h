#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/run/stack_port.h"
#include "core/background_worker.h"
#include "stack/stack.h"

namespace patrol::app {

/// The built-in stack, with turns when its odometry, control or map is due. It decodes the messages of the simulator as
/// a stack in another process does, so that both compute with the same numbers.
class BuiltInStack final : public StackPort {
 public:
  /// `has_thread`: whether the stack computes in a thread of its own, with the same results.
  BuiltInStack(stack::Stack stack, const stack::ComputeSettings& compute, bool has_thread);

  void deliver(link::DeliveredMessage message) override;
  void begin_turn(Time now) override;
  StackAnswer end_turn() override;
  std::vector<PublishedMessage> finish(Time now) override;
  std::optional<Time> known_delay() const override;
  void serialize_state(StateArchive& archive) override;
  bool records_turns() const override { return compute_.model != "free"; }
  std::map<std::string, double> seconds_by_stage() const override { return stack_.clock().seconds(); }
  std::map<std::string, std::uint64_t> calls_by_stage() const override { return stack_.clock().calls(); }

  static constexpr Time kMinTurnPeriod = std::chrono::milliseconds(10);  ///< shortest interval between two turns

 private:
  void handle_early();
  void handle(const std::vector<link::DeliveredMessage>& messages);
  void step(Time now, const std::vector<link::DeliveredMessage>& messages);
  std::vector<PublishedMessage> published();

  stack::Stack stack_;
  stack::ComputeSettings compute_;
  StackAnswer answer_;                            ///< answer to the last turn
  std::vector<link::DeliveredMessage> messages_;  ///< messages that the stack has not received
  std::size_t num_bytes_ = 0;                     ///< total size of `messages_`
  BackgroundWorker::Ticket last_task_ = 0, turn_task_ = 0;
  BackgroundWorker worker_;  ///< last member: its thread ends before the others do
};

}  // namespace patrol::app
