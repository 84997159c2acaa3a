#include "app/run/run_loop.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "core/geometry/angles.h"
#include "core/overloaded.h"
#include "core/state/message_state.h"
#include "io/logs/run_log.h"

namespace patrol::app {
namespace {

/// Clock divider: `is_due` is true once per period, beginning with the first call.
class Schedule {
 public:
  explicit Schedule(double rate_hz) : period_(from_seconds(1.0 / rate_hz)) {}
  bool is_due(Time now) {
    if (now < next_) return false;
    next_ += period_;
    return true;
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(next_);
  }

 private:
  Time period_;
  Time next_{};
};

/// Time without a velocity command after which the robot's base stops.
constexpr Time kCommandTimeout = std::chrono::milliseconds(500);

/// Message that is a command to the simulator's instruments.
template <typename Message>
concept InstrumentOrder = std::is_constructible_v<InstrumentCommand, Message>;

/// Closed loop of simulator and stack: exchanges their messages, writes the log and notifies the observer.
class ClosedLoop {
 public:
  ClosedLoop(const Scenario& scenario, sim::Simulator& simulator, StackPort& stack, io::RunLogWriter& log,
             RunObserver& observer, const RunPart& part)
      : simulator_(simulator),
        stack_(stack),
        observer_(observer),
        log_(log),
        part_(part),
        truth_due_(scenario.log.truth_rate_hz),
        state_due_(scenario.log.state_rate_hz),
        limit_(from_seconds(scenario.time_limit_s)),
        kidnaps_(scenario.kidnaps),
        last_position_(simulator.truth().T_world_body.position) {
    std::stable_sort(kidnaps_.begin(), kidnaps_.end(), [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
    if (!part_.start.empty()) {
      restore();
    } else if (const AsBuiltTruth as_built = simulator_.as_built(); !as_built.values.empty()) {
      log_.write(Time{}, as_built);
    }
    next_snapshot_ = simulator_.now() + part_.snapshot_period;
    messages_ = part_.traced_messages;
  }

  /// Runs until a time and returns the state; empty if the run ends before.
  std::string run_until(Time end) {
    for (bool is_running = true; is_running;) {
      save_snapshot();
      trace();
      if (simulator_.now() >= end) return state();
      is_running = tick();
    }
    trace();
    return {};
  }

  const RunOutcome& outcome() const { return outcome_; }

  RunOutcome run() {
    try {
      for (bool is_running = true; is_running;) {
        save_snapshot();
        trace();
        is_running = tick();
      }
      finish_stack(simulator_.now());
    } catch (const link::LinkError& error) {
      record_ground_truth(simulator_.now());
      set_failure(outcome_, error);
    }
    finish();
    return std::move(outcome_);
  }

 private:
  /// Exchanges the messages of an instant and advances the simulator. Returns false at the end of the run.
  bool tick() {
    const Time now = simulator_.now();
    deliver_sensor_messages(now);
    deliver_fall(now);
    give_turn(now);
    if (now - command_time_ > kCommandTimeout) simulator_.set_command({});
    trigger_kidnaps(now);
    record_ground_truth(now);
    if (!keep_running(now)) return false;
    simulator_.step();
    return true;
  }

  void serialize_state(StateArchive& archive) {
    archive.section("loop");
    simulator_.serialize_state(archive);
    stack_.serialize_state(archive);
    archive(truth_due_, state_due_, progress_due_, last_position_, distance_m_, turn_, answer_, answer_time_,
            next_turn_, command_time_, fall_time_, mission_is_over_, outcome_.end, outcome_.num_kidnaps);
  }

  std::string state() {
    if (turn_is_running_) take_answer();
    StateArchive archive;
    serialize_state(archive);
    return archive.bytes();
  }

  void restore() {
    StateArchive archive(part_.start);
    serialize_state(archive);
    if (!archive.is_at_end()) throw std::runtime_error("state is longer than expected");
    start_ = simulator_.now();
  }

  void save_snapshot() {
    const Time now = simulator_.now();
    bool is_due = false;
    if (part_.snapshot_period > Time{} && now >= next_snapshot_) {
      next_snapshot_ += part_.snapshot_period;
      is_due = true;
    }
    for (; num_snapshots_ < part_.snapshot_times.size() && now >= part_.snapshot_times[num_snapshots_];
         ++num_snapshots_)
      is_due = true;
    if (!is_due) return;
    const auto timer = profiler_.time_stage("snapshots");
    part_.save(now, state());
  }

  /// Reports the hashes of a tick.
  void trace() {
    if (!part_.trace || simulator_.now() < part_.trace_from) return;
    const auto hash_of = [](auto& part) {
      StateArchive archive = StateArchive::for_comparison();
      archive(part);
      return hash_bytes(archive.bytes());
    };
    SimState motion = simulator_.state();
    part_.trace({.time = simulator_.now(),
                 .motion = hash_of(motion),
                 .messages = messages_,
                 .simulator = hash_of(simulator_),
                 .stack = hash_of(stack_)});
  }

  void trace_message(const std::string& topic, const std::string& cdr) {
    if (part_.trace && simulator_.now() >= part_.trace_from) messages_ = hash_bytes(cdr, hash_bytes(topic, messages_));
  }

  void deliver_sensor_messages(Time now) {
    for (const SensorMessage& message : simulator_.take_messages())
      std::visit([&](const auto& content) { deliver(now, content); }, message);
  }

  void deliver_fall(Time now) {
    if (fall_time_ || !simulator_.has_fallen()) return;
    fall_time_ = now;
    deliver(now, FallReport{now});
    outcome_.end = RunEnd::kFall;
  }

  /// Writes a message and hands it over to the stack.
  template <typename Message>
  void deliver(Time now, const Message& message) {
    link::DeliveredMessage delivered{.topic = io::kTopic<Message>, .log_time = now, .cdr = write(now, message)};
    trace_message(delivered.topic, delivered.cdr);
    stack_.deliver(std::move(delivered));
  }

  template <typename Message>
  std::string write(Time now, const Message& message) {
    const auto timer = profiler_.time_stage("log");
    return log_.write(now, message);
  }

  /// Publishes what the stack has computed by now, and lets it begin a turn when it is due and the mission is not over.
  /// The simulator continues beside a turn whose delay is known.
  void give_turn(Time now) {
    publish_answer(now);
    if (mission_is_over_ || turn_is_running_ || answer_ || now < next_turn_) return;
    turn_ = now;
    stack_.begin_turn(now);
    turn_is_running_ = true;
    if (const std::optional<Time> delay = stack_.known_delay()) answer_time_ = now + *delay;
    else take_answer();
    publish_answer(now);
  }

  void take_answer() {
    answer_ = stack_.end_turn();
    turn_is_running_ = false;
    answer_time_ = turn_ + answer_->delay;
    next_turn_ = answer_->next_turn;
  }

  void publish_answer(Time now) {
    if (now < answer_time_) return;
    if (turn_is_running_) take_answer();
    if (!answer_) return;
    publish(now, *answer_);
    mission_is_over_ = answer_->mission_is_over || (fall_time_ && turn_ >= *fall_time_);
    answer_.reset();
  }

  void publish(Time now, const StackAnswer& answer) {
    record_turn(now, record_of(turn_, answer));
    publish(now, answer.messages);
  }

  void record_turn(Time now, const StackTurnRecord& record) {
    if (stack_.records_turns()) write(now, record);
  }

  void publish(Time now, const std::vector<PublishedMessage>& messages) {
    for (const PublishedMessage& message : messages) {
      {
        const auto timer = profiler_.time_stage("log");
        write_published(log_, now, message);
      }
      trace_message(message.topic, message.cdr);
      if (!message.content) continue;
      std::visit(Overloaded{[](const auto&) {},
                            [&](const VelocityCommand& command) {
                              simulator_.set_command(command);
                              command_time_ = now;
                            },
                            [&]<InstrumentOrder Command>(const Command& order) { simulator_.command(order); }},
                 *message.content);
      observer_.on_message(*message.content);
    }
  }

  void trigger_kidnaps(Time now) {
    const auto is_due = [&](const KidnapSettings& kidnap) { return from_seconds(kidnap.at_s) <= now; };
    while (outcome_.num_kidnaps < kidnaps_.size() && is_due(kidnaps_[outcome_.num_kidnaps])) {
      const KidnapSettings& kidnap = kidnaps_[outcome_.num_kidnaps++];
      simulator_.teleport({kidnap.x_m, kidnap.y_m, to_rad(kidnap.heading_deg)});
    }
  }

  void record_ground_truth(Time now) {
    const GroundTruth truth = simulator_.truth();
    for (const Collision& collision : simulator_.take_collisions()) write(now, collision);
    if (truth_due_.is_due(now)) {
      distance_m_ += (truth.T_world_body.position - last_position_).head<2>().norm();
      last_position_ = truth.T_world_body.position;
      write(now, truth);
      observer_.on_ground_truth(truth);
    }
    if (state_due_.is_due(now)) write(now, simulator_.state());
  }

  /// Checks the end of the mission, the time limit and the observer, and sets the outcome's end. A fall and the end of
  /// the mission precede the time limit.
  bool keep_running(Time now) {
    if (now >= limit_ && !fall_time_ && !mission_is_over_) outcome_.end = RunEnd::kTimeLimit;
    if (progress_due_.is_due(now) && !observer_.keep_running(now, distance_m_)) {
      outcome_.end = RunEnd::kInterrupted;
      return false;
    }
    return !mission_is_over_ && now < limit_;
  }

  /// Lets the stack publish its last results.
  void finish_stack(Time now) {
    if (turn_is_running_) take_answer();
    if (answer_) publish(now, *answer_);
    const std::vector<PublishedMessage> messages = stack_.finish(now);
    record_turn(now, record_of_last(now));
    publish(now, messages);
  }

  /// Closes the log and completes the outcome.
  void finish() {
    log_.close();
    outcome_.duration = simulator_.now();
    outcome_.start = start_;
    outcome_.faults = simulator_.sensors().faults();
    outcome_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
    outcome_.cpu_s = process_seconds() - cpu_start_;
    outcome_.seconds_by_stage = stack_.seconds_by_stage();
    outcome_.calls_by_stage = stack_.calls_by_stage();
    for (const StageProfiler* part : {&simulator_.clock(), &std::as_const(profiler_)}) {
      for (const auto& [name, seconds] : part->seconds()) outcome_.seconds_by_stage[name] += seconds;
      for (const auto& [name, calls] : part->calls()) outcome_.calls_by_stage[name] += calls;
    }
    // Expensive sensors are stages of their own.
    for (const auto& [name, seconds] : simulator_.sensors().clock().seconds()) {
      outcome_.seconds_by_stage[name] += seconds;
      outcome_.seconds_by_stage["sensors"] -= seconds;
    }
    for (const auto& [name, calls] : simulator_.sensors().clock().calls()) outcome_.calls_by_stage[name] += calls;
    if (const double thread_s = simulator_.sensors().thread_s(); thread_s > 0.0)
      outcome_.seconds_by_stage["sensor_thread"] = thread_s;
  }

  const std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
  const double cpu_start_ = process_seconds();
  sim::Simulator& simulator_;
  StackPort& stack_;
  RunObserver& observer_;
  io::RunLogWriter& log_;
  const RunPart& part_;
  StageProfiler profiler_;
  Schedule truth_due_, state_due_, progress_due_{2.0};
  Time limit_;
  std::vector<KidnapSettings> kidnaps_;  ///< kidnappings in ascending time order
  Eigen::Vector3d last_position_;
  double distance_m_ = 0.0;
  Time turn_{};                        ///< last turn
  bool turn_is_running_ = false;       ///< the stack has begun the turn and may compute
  std::optional<StackAnswer> answer_;  ///< answer that has not taken effect
  Time answer_time_{}, next_turn_{};
  Time command_time_{};  ///< time of the last velocity command
  std::optional<Time> fall_time_;
  bool mission_is_over_ = false;
  RunOutcome outcome_;
  Time start_{};                   ///< start of this part
  std::uint64_t messages_ = 0;     ///< hash of the traced messages
  Time next_snapshot_{};           ///< periodic
  std::size_t num_snapshots_ = 0;  ///< number of snapshots made at the given instants
};

}  // namespace

void write_published(io::RunLogWriter& log, Time now, const PublishedMessage& message) {
  if (message.content) {
    std::visit([&]<typename Content>(const Content&) { log.write_encoded<Content>(now, message.cdr); },
               *message.content);
  } else {
    log.write_foreign(now, message.topic, message.type, message.definition, message.cdr);
  }
}

void set_failure(RunOutcome& outcome, const link::LinkError& error) {
  outcome.stack_failure = error.what();
  outcome.end = error.fault() == link::LinkFault::kInterrupted ? RunEnd::kInterrupted
                : error.fault() == link::LinkFault::kTimeout   ? RunEnd::kStackSilent
                                                               : RunEnd::kStackFailed;
}

std::string run_until(Time end, const Scenario& scenario, sim::Simulator& simulator, StackPort& stack,
                      io::RunLogWriter& log, RunObserver& observer, const RunPart& part) {
  ClosedLoop loop(scenario, simulator, stack, log, observer, part);
  std::string state = loop.run_until(end);
  if (state.empty() && !part.trace && loop.outcome().end != RunEnd::kInterrupted) {
    throw InputError(
        fmt::format("--from: the run ends at {:.3f} s, before {:.3f} s", to_seconds(simulator.now()), to_seconds(end)));
  }
  return state;
}

RunOutcome run_to_end(const Scenario& scenario, sim::Simulator& simulator, StackPort& stack, io::RunLogWriter& log,
                      RunObserver& observer, const RunPart& part) {
  return ClosedLoop(scenario, simulator, stack, log, observer, part).run();
}

RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, sim::Simulator& simulator, StackPort& stack,
                    const std::filesystem::path& log_mcap, RunObserver& observer) {
  observer.begin(files);
  io::RunLogWriter log(log_mcap, files.robot);
  return run_to_end(scenario, simulator, stack, log, observer, {});
}

}  // namespace patrol::app
