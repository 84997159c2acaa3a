#include "app/run/built_in_stack.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "app/run/compute_delay.h"
#include "core/sensors/registry.h"
#include "core/thread_cpu_time.h"
#include "io/logs/topics.h"

namespace patrol::app {

BuiltInStack::BuiltInStack(stack::Stack stack, const stack::ComputeSettings& compute, bool has_thread)
    : stack_(std::move(stack)), compute_(compute), worker_(has_thread) {}

std::optional<Time> BuiltInStack::known_delay() const { return known_delay_of(compute_); }

void BuiltInStack::deliver(link::DeliveredMessage message) {
  num_bytes_ += message.cdr.size();
  messages_.push_back(std::move(message));
  if (num_bytes_ >= link::kEarlyBytes && known_delay()) handle_early();  // a measured turn handles its messages itself
}

void BuiltInStack::handle_early() {
  if (messages_.empty()) return;
  last_task_ = worker_.submit([this, messages = std::exchange(messages_, {})] { handle(messages); });
  num_bytes_ = 0;
}

void BuiltInStack::begin_turn(Time now) {
  auto turn = [this, now, messages = std::exchange(messages_, {})] { step(now, messages); };
  num_bytes_ = 0;
  if (known_delay().value_or(Time{}) > Time{}) {
    turn_task_ = last_task_ = worker_.submit(std::move(turn));
  } else {  // the simulator waits for the answer: the thread need not wake up
    worker_.wait(last_task_);
    turn();
  }
}

StackAnswer BuiltInStack::end_turn() {
  worker_.wait(turn_task_);
  return std::exchange(answer_, {});
}

std::vector<PublishedMessage> BuiltInStack::finish(Time now) {
  worker_.wait(last_task_);
  handle(messages_);
  stack_.finish(now);
  return published();
}

void BuiltInStack::serialize_state(StateArchive& archive) {
  handle_early();
  worker_.wait(last_task_);
  stack_.serialize_state(archive);
}

void BuiltInStack::handle(const std::vector<link::DeliveredMessage>& messages) {
  for (const link::DeliveredMessage& message : messages) {
    if (message.topic == io::kTopic<FallReport>) {
      stack_.handle_fall(message.log_time);
    } else if (const auto content = io::decode_as<SensorMessage>(message.topic, message.cdr)) {
      stack_.handle(*content, message.log_time);
    }
  }
}

void BuiltInStack::step(Time now, const std::vector<link::DeliveredMessage>& messages) {
  const double start_s = thread_cpu_time_s();
  handle(messages);
  stack_.step(now);
  const double cpu_s = thread_cpu_time_s() - start_s;
  answer_ = {.messages = published(),
             .next_turn = std::max(stack_.next_step(), now + kMinTurnPeriod),
             .mission_is_over = stack_.mission_is_over(),
             .delay = delay_of(compute_, cpu_s)};
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
