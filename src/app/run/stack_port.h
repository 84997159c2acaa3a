#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

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

/// Turn of the stack, with the messages that were delivered since the last one.
struct StackTurn {
  Time now{};
  std::vector<link::DeliveredMessage> messages;
};

/// Answer of the stack to a turn.
struct StackAnswer {
  std::vector<PublishedMessage> messages;
  Time next_turn{};
  bool mission_is_over = false;
  Time delay{};  ///< time from the start of the turn until its messages take effect
};

/// The robot's software in the closed loop of a run. Throws link::LinkError if software in another process fails.
class StackPort {
 public:
  StackPort() = default;
  virtual ~StackPort() = default;
  StackPort(const StackPort&) = delete;
  StackPort& operator=(const StackPort&) = delete;

  virtual StackAnswer take_turn(const StackTurn& turn) = 0;
  /// Ends the run: the stack completes its map and publishes its last results.
  virtual std::vector<PublishedMessage> finish(const StackTurn& turn) = 0;
  /// Returns whether the log has a StackTurn of every turn. Otherwise the turns are those of the built-in stack,
  /// without delay.
  virtual bool records_turns() const = 0;
  /// Saves or restores the state between two turns. Throws InputError if the method of the stack cannot be saved, and
  /// std::logic_error for software in another process, whose runs are refused before it starts.
  virtual void serialize_state(StateArchive& /*archive*/) {
    throw std::logic_error("state of a stack in another process");
  }
  /// Returns the wall time by stage.
  virtual std::map<std::string, double> seconds_by_stage() const = 0;
  /// Returns the number of calls by stage; empty for software in another process.
  virtual std::map<std::string, std::uint64_t> calls_by_stage() const { return {}; }
};

}  // namespace patrol::app
