#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/state/state_archive_fwd.h"
#include "core/time.h"
#include "link/delivered_message.h"
#include "stack/output/stack_message.h"

namespace patrol::app {

/// Message that the stack publishes. A topic that Patrol does not know has no content, but the name and the definition
/// of its type.
struct PublishedMessage {
  std::optional<stack::StackMessage> content;
  std::string topic;
  std::string type = {}, definition = {};
  std::string cdr;
};

/// Answer of the stack to a turn.
struct StackAnswer {
  std::vector<PublishedMessage> messages;
  Time next_turn{};
  bool mission_is_over = false;
  Time delay{};  ///< time from the start of the turn until its messages take effect
};

/// Record of a turn and of its answer.
inline StackTurnRecord record_of(Time turn, const StackAnswer& answer) {
  return {.turn = turn,
          .delay = answer.delay,
          .next_turn = answer.next_turn,
          .is_last = false,
          .mission_is_over = answer.mission_is_over};
}

/// Record of the last turn, whose messages have no delay.
inline StackTurnRecord record_of_last(Time turn) {
  return {.turn = turn, .delay = {}, .next_turn = turn, .is_last = true, .mission_is_over = true};
}

/// The robot's software in the closed loop of a run. Use: `deliver` each message; `begin_turn`; `end_turn`; at the end
/// `finish`. The stack may process messages before its turn, and the turn until its end, beside the simulator: its
/// answers do not depend on that. Throws link::LinkError if software in another process fails.
class StackPort {
 public:
  StackPort() = default;
  virtual ~StackPort() = default;
  StackPort(const StackPort&) = delete;
  StackPort& operator=(const StackPort&) = delete;

  /// Hands over a message for the next turn to begin.
  virtual void deliver(link::DeliveredMessage message) = 0;
  virtual void begin_turn(Time now) = 0;
  /// Waits for the answer to the turn that has begun.
  virtual StackAnswer end_turn() = 0;
  StackAnswer take_turn(Time now) {
    begin_turn(now);
    return end_turn();
  }
  /// Ends the run: the stack completes its map and publishes its last results.
  virtual std::vector<PublishedMessage> finish(Time now) = 0;
  /// Returns the delay of every answer if it is known before the end of the turn.
  virtual std::optional<Time> known_delay() const { return std::nullopt; }
  /// Returns whether the log has a StackTurn of every turn. Otherwise the turns are those of the built-in stack,
  /// without delay.
  virtual bool records_turns() const = 0;
  /// Saves or restores the state after the end of a turn. Throws InputError if the method of the stack cannot be saved,
  /// and std::logic_error for software in another process, whose runs are refused before it starts.
  virtual void serialize_state(StateArchive& /*archive*/) {
    throw std::logic_error("state of a stack in another process");
  }
  /// Returns the wall time by stage.
  virtual std::map<std::string, double> seconds_by_stage() const = 0;
  /// Returns the number of calls by stage; empty for software in another process.
  virtual std::map<std::string, std::uint64_t> calls_by_stage() const { return {}; }
};

}  // namespace patrol::app
