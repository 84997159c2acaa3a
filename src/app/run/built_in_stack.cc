#include "app/run/built_in_stack.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "app/run/compute_delay.h"
#include "core/sensors/registry.h"
#include "core/thread_cpu_time.h"
#include "io/logs/topics.h"

namespace patrol::app {

BuiltInStack::BuiltInStack(stack::Stack stack, const stack::ComputeSettings& compute)
    : stack_(std::move(stack)), compute_(compute) {}

StackAnswer BuiltInStack::take_turn(const StackTurn& turn) {
  const double start_s = thread_cpu_time_s();
  handle(turn);
  stack_.step(turn.now);
  const double cpu_s = thread_cpu_time_s() - start_s;
  return {.messages = published(),
          .next_turn = std::max(stack_.next_step(), turn.now + kMinTurnPeriod),
          .mission_is_over = stack_.mission_is_over(),
          .delay = delay_of(compute_, cpu_s)};
}

std::vector<PublishedMessage> BuiltInStack::finish(const StackTurn& turn) {
  handle(turn);
  stack_.finish(turn.now);
  return published();
}

void BuiltInStack::handle(const StackTurn& turn) {
  for (const link::DeliveredMessage& message : turn.messages) {
    if (message.topic == io::kTopic<FallReport>) {
      stack_.handle_fall(message.log_time);
    } else if (const auto content = io::decode_as<SensorMessage>(message.topic, message.cdr)) {
      stack_.handle(*content);
    }
  }
}

std::vector<PublishedMessage> BuiltInStack::published() {
  std::vector<PublishedMessage> messages;
  for (stack::StackMessage& content : stack_.take_messages()) {
    PublishedMessage message;
    std::visit(
        [&]<typename Message>(const Message& one) {
          message.topic = io::kTopic<Message>;
          message.cdr = io::encode(one);
        },
        content);
    message.content = std::move(content);
    messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace patrol::app
