#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/stage_profiler.h"
#include "stack/output/stack_message.h"

namespace patrol::stack {

/// Collector of the messages published by the components of the stack, in order, and of their computing time.
class StackOutput {
 public:
  template <typename Message>
  void publish(Message&& message) {
    messages_.emplace_back(std::forward<Message>(message));
  }
  /// Publishes an event at the robot's own position.
  void publish_event(Time now, const Pose2& T_map_body, EventKind kind, const std::string& text,
                     const std::string& subject = "") {
    publish(Event{.stamp = now,
                  .kind = kind,
                  .subject = subject,
                  .text = text,
                  .value = 0.0,
                  .T_map_body = T_map_body,
                  .p_map_target = T_map_body.position()});
  }
  /// Appends the messages and adds the computing time of another collector.
  void take(StackOutput other) {
    for (StackMessage& message : other.messages_) messages_.push_back(std::move(message));
    clock_.add(other.clock_);
  }
  /// Removes and returns the messages published since the last call.
  std::vector<StackMessage> take_messages() { return std::exchange(messages_, {}); }

  [[nodiscard]] StageProfiler::ScopedTimer time_stage(const std::string& part) { return clock_.time_stage(part); }
  const StageProfiler& clock() const { return clock_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(messages_);
  }

 private:
  std::vector<StackMessage> messages_;
  StageProfiler clock_;
};

}  // namespace patrol::stack
