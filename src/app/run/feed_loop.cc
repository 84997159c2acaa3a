#include "app/run/feed_loop.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "app/common/process_cost.h"
#include "io/logs/run_log.h"
#include "io/mcap/mcap_reader.h"
#include "link/link_error.h"

namespace patrol::app {
namespace {

constexpr Time kProgressPeriod = std::chrono::milliseconds(500);

/// Topics of the simulator in a log: inputs of the stack, and ground truth.
std::vector<std::string> simulator_topics() {
  std::vector<std::string> topics;
  for (const io::TopicInfo& info : io::topic_infos()) {
    if (io::is_stack_input(info.topic) || std::string_view(info.source) == "ground truth")
      topics.emplace_back(info.topic);
  }
  return topics;
}

/// Stack that is fed with a log.
class FeedLoop {
 public:
  FeedLoop(const std::filesystem::path& input_mcap, const ScenarioFiles& files, Time tick, StackPort& stack,
           const std::filesystem::path& log_mcap, RunObserver& observer, const std::vector<StackTurnRecord>& turns)
      : tick_(tick),
        stack_(stack),
        observer_(observer),
        input_(input_mcap, {.topics = simulator_topics()}),
        turns_(turns),
        log_(log_mcap, files.robot) {
    end_ = io::last_message_time(input_mcap);
    observer.begin(files);
  }

  RunOutcome run() {
    try {
      if (turns_.empty()) take_own_turns();
      else take_recorded_turns();
    } catch (const link::LinkError& error) {
      set_failure(outcome_, error);
      has_failed_ = true;
      deliver_until(outcome_.duration, true);  // the ground truth until then, by which the run is scored
    }
    log_.close();
    outcome_.wall_s = wall_seconds() - wall_start_s_;
    outcome_.cpu_s = process_seconds() - cpu_start_s_;
    outcome_.seconds_by_stage = stack_.seconds_by_stage();
    return std::move(outcome_);
  }

 private:
  /// Message of the simulator in the log.
  struct Input {
    link::DeliveredMessage message;
    std::string type, definition;
  };

  void take_own_turns() {
    bool mission_is_over = false;
    Time next_turn{};
    for (Time now{}; now <= end_ && !mission_is_over; now = std::max(now + tick_, tick_at(next_turn))) {
      if (!keep_running(now)) return;
      outcome_.duration = now;
      const StackAnswer answer = take_turn(now, std::nullopt);
      mission_is_over = answer.mission_is_over || (fall_time_ && now >= *fall_time_);
      if (mission_is_over) outcome_.duration = answer_time(now, answer.delay);
      next_turn = std::max(answer.next_turn, now + answer.delay);
    }
    if (!mission_is_over) outcome_.duration = end_;
    finish(outcome_.duration);
  }

  void take_recorded_turns() {
    for (const StackTurnRecord& record : turns_) {
      if (!keep_running(record.turn)) return;
      outcome_.duration = record.turn;
      if (record.is_last) return finish(record.turn);
      take_turn(record.turn, record.delay);
    }
  }

  /// First tick that is not earlier than a time.
  Time tick_at(Time time) const { return (time + tick_ - Time{1}) / tick_ * tick_; }

  /// Time at which the answer to a turn takes effect: a tick, at most the end of the log.
  Time answer_time(Time turn, Time delay) const { return std::min(tick_at(turn + delay), end_); }

  /// Lets the stack take a turn and publishes its answer when it takes effect, after the messages of the simulator
  /// until then. `recorded_delay`: instead of the delay of the answer.
  StackAnswer take_turn(Time now, const std::optional<Time>& recorded_delay) {
    deliver_until(now, false);
    StackAnswer answer = stack_.take_turn(now);
    answer.delay = recorded_delay.value_or(answer.delay);
    const Time time = answer_time(now, answer.delay);
    deliver_until(time, tick_at(now + answer.delay) > end_);
    record_turn(time, record_of(now, answer));
    publish(time, answer.messages);
    return answer;
  }

  void record_turn(Time now, const StackTurnRecord& record) {
    if (stack_.records_turns()) log_.write(now, record);
  }

  void finish(Time now) {
    deliver_until(now, true);
    const std::vector<PublishedMessage> messages = stack_.finish(now);
    record_turn(now, record_of_last(now));
    publish(now, messages);
  }

  /// Writes the messages of the simulator up to a time, and delivers those for the stack. The ground truth
  /// of that time is written after the answers, unless the run ends. The true values as built precede the first turn.
  void deliver_until(Time now, bool is_end) {
    while (true) {
      if (!next_input_) next_input_ = read_input();
      if (!next_input_) return;
      link::DeliveredMessage& message = next_input_->message;
      const bool is_for_stack = io::is_stack_input(message.topic);
      const bool is_before_turn = is_for_stack || message.topic == io::kTopic<AsBuiltTruth>;
      if (message.log_time > now || (!is_before_turn && !is_end && message.log_time == now)) return;
      log_.write_foreign(message.log_time, message.topic, next_input_->type, next_input_->definition, message.cdr);
      if (message.topic == io::kTopic<FallReport>) fall_time_ = message.log_time;
      if (is_for_stack && !has_failed_) stack_.deliver(std::move(message));
      next_input_.reset();
    }
  }

  std::optional<Input> read_input() {
    const std::optional<io::McapMessage> message = input_.next();
    if (!message) return std::nullopt;
    return Input{
        .message = {.topic = message->channel.topic, .log_time = message->log_time, .cdr = std::string(message->cdr)},
        .type = message->channel.type,
        .definition = message->channel.definition};
  }

  void publish(Time now, const std::vector<PublishedMessage>& messages) {
    for (const PublishedMessage& message : messages) {
      write_published(log_, now, message);
      if (message.content) observer_.on_message(*message.content);
    }
  }

  bool keep_running(Time now) {
    if (now < next_progress_) return true;
    next_progress_ = now + kProgressPeriod;
    if (observer_.keep_running(now, 0.0)) return true;
    outcome_.end = RunEnd::kInterrupted;
    return false;
  }

  const double wall_start_s_ = wall_seconds(), cpu_start_s_ = process_seconds();
  Time tick_;
  StackPort& stack_;
  RunObserver& observer_;
  io::McapReader input_;
  const std::vector<StackTurnRecord>& turns_;
  io::RunLogWriter log_;
  Time end_{};
  Time next_progress_{};
  std::optional<Input> next_input_;
  std::optional<Time> fall_time_;
  bool has_failed_ = false;  ///< whether the stack has failed
  RunOutcome outcome_;
};

}  // namespace

RunOutcome feed_loop(const std::filesystem::path& input_mcap, const ScenarioFiles& files, Time tick, StackPort& stack,
                     const std::filesystem::path& log_mcap, RunObserver& observer,
                     const std::vector<StackTurnRecord>& turns) {
  return FeedLoop(input_mcap, files, tick, stack, log_mcap, observer, turns).run();
}

}  // namespace patrol::app
