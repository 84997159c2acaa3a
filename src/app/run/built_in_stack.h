#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "app/run/stack_port.h"
#include "stack/stack.h"

namespace patrol::app {

/// The built-in stack, with turns when its odometry, control or map is due. It decodes the messages of the simulator as
/// a stack in another process does, so that both compute with the same numbers.
class BuiltInStack final : public StackPort {
 public:
  BuiltInStack(stack::Stack stack, const stack::ComputeSettings& compute);

  StackAnswer take_turn(const StackTurn& turn) override;
  std::vector<PublishedMessage> finish(const StackTurn& turn) override;
  void serialize_state(StateArchive& archive) override { stack_.serialize_state(archive); }
  bool records_turns() const override { return compute_.model != "free"; }
  std::map<std::string, double> seconds_by_stage() const override { return stack_.clock().seconds(); }
  std::map<std::string, std::uint64_t> calls_by_stage() const override { return stack_.clock().calls(); }

  static constexpr Time kMinTurnPeriod = std::chrono::milliseconds(10);  ///< shortest interval between two turns

 private:
  void handle(const StackTurn& turn);
  std::vector<PublishedMessage> published();

  stack::Stack stack_;
  stack::ComputeSettings compute_;
};

}  // namespace patrol::app
