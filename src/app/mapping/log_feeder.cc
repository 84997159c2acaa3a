#include "app/mapping/log_feeder.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/overloaded.h"

namespace patrol::app {

void LogFeeder::advance(Time now) {
  if (now <= now_) return;
  if (has_new_messages_ && now_ >= next_turn_) take_turn();
  now_ = now;
}

void LogFeeder::deliver(const io::McapChannel& channel, std::string_view cdr) {
  log_.write_foreign(now_, channel.topic, channel.type, channel.definition, cdr);
  give({.topic = channel.topic, .log_time = now_, .cdr = std::string(cdr)});
}

void LogFeeder::give(link::DeliveredMessage message) {
  stack_->deliver(std::move(message));
  has_new_messages_ = true;
}

void LogFeeder::take_turn() {
  const StackAnswer answer = stack_->take_turn(now_);
  has_new_messages_ = false;
  next_turn_ = answer.next_turn;
  record_turn(record_of(now_, answer));
  publish(answer.messages);
}

void LogFeeder::record_turn(const StackTurnRecord& record) {
  if (stack_->records_turns()) log_.write(record.turn, record);
}

void LogFeeder::publish(const std::vector<PublishedMessage>& messages) {
  for (const PublishedMessage& message : messages) {
    write_published(log_, now_, message);
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

void LogFeeder::finish() {
  const std::vector<PublishedMessage> messages = stack_->finish(now_);
  record_turn(record_of_last(now_));
  publish(messages);
}

FedAnswers LogFeeder::answers(RunOutcome outcome) {
  log_.close();
  fed_.outcome = std::move(outcome);
  fed_.outcome.seconds_by_stage = stack_->seconds_by_stage();
  return std::move(fed_);
}

}  // namespace patrol::app
