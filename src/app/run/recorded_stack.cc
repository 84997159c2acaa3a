#include "app/run/recorded_stack.h"

#include <string_view>
#include <utility>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "io/logs/topics.h"

namespace patrol::app {
namespace {

/// Returns whether the simulator writes a topic at the end of a tick.
bool is_ground_truth(const std::string& topic) {
  const std::optional<io::TopicInfo> info = io::find_topic(topic);
  return info && std::string_view(info->source) == "ground truth" && topic != io::kTopic<AsBuiltTruth>;
}

}  // namespace

RecordedStack::RecordedStack(const std::filesystem::path& log_mcap, Time tick, bool has_turns)
    : tick_(tick), has_turns_(has_turns), reader_(log_mcap) {
  if (!reader_.last_time()) throw InputError(log_mcap.string() + ": is incomplete");
  end_ = *reader_.last_time();
  next_ = next_entry();
}

StackAnswer RecordedStack::end_turn() {
  StackAnswer answer{.messages = {}, .next_turn = turn_ + tick_};
  if (has_turns_) {
    answer.mission_is_over = !next_;
    if (!next_ || !next_->turn || next_->turn->turn != turn_) return answer;
    const StackTurnRecord record = *next_->turn;
    answer.next_turn = record.next_turn;
    answer.delay = record.delay;
    answer.mission_is_over = record.mission_is_over;
    answer.messages = take_until_next_turn();
    return answer;
  }
  answer.mission_is_over = turn_ >= end_;
  while (next_ && !next_->follows_truth && next_->log_time <= turn_) {
    answer.messages.push_back(std::move(next_->message));
    next_ = next_entry();
  }
  return answer;
}

std::vector<PublishedMessage> RecordedStack::finish(Time /*now*/) { return take_until_next_turn(); }

/// Removes and returns the messages of a turn, whose record is next in a log that has them.
std::vector<PublishedMessage> RecordedStack::take_until_next_turn() {
  std::vector<PublishedMessage> messages;
  if (next_ && next_->turn) next_ = next_entry();
  for (; next_ && !next_->turn; next_ = next_entry()) messages.push_back(std::move(next_->message));
  return messages;
}

std::optional<RecordedStack::Entry> RecordedStack::next_entry() {
  while (const std::optional<io::McapMessage> message = reader_.next()) {
    const std::string& topic = message->channel.topic;
    if (topic == io::kTopic<StackTurnRecord>) {
      return Entry{.log_time = message->log_time, .message = {}, .turn = io::decode<StackTurnRecord>(message->cdr)};
    }
    if (is_ground_truth(topic)) truth_time_ = message->log_time;
    if (!io::is_stack_output(topic)) continue;
    Entry entry{.log_time = message->log_time,
                .message = {.content = io::decode_as<stack::StackMessage>(topic, message->cdr),
                            .topic = topic,
                            .cdr = std::string(message->cdr)},
                .turn = {},
                .follows_truth = truth_time_ == message->log_time};
    if (!entry.message.content) {
      entry.message.type = message->channel.type;
      entry.message.definition = message->channel.definition;
    }
    return entry;
  }
  return std::nullopt;
}

std::vector<StackTurnRecord> read_turn_records(const std::filesystem::path& log_mcap) {
  std::vector<StackTurnRecord> turns;
  io::LogHandlers handlers;
  handlers.on<StackTurnRecord>([&](Time, const StackTurnRecord& turn) { turns.push_back(turn); });
  io::read_run_log(log_mcap, handlers);
  return turns;
}

}  // namespace patrol::app
