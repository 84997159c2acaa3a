#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "link/protocol.h"
#include "link/record_stream.h"

namespace patrol::link {

/// Message that a stack published, as it came.
struct PublishedMessage {
  std::string topic, type, definition;
  std::string cdr;
};

/// Answer of a stack to a turn.
struct TurnAnswer {
  std::vector<PublishedMessage> messages;
  Time next_turn{};
  bool mission_is_over = false;
};

/// Limits on the messages that a stack publishes in one turn.
struct TurnLimits {
  std::size_t num_messages = 10'000;
  std::size_t bytes = std::size_t{256} << 20;
};

/// Side of the simulator of a connection to a stack. Throws LinkError whose text does not name the stack.
class StackServer {
 public:
  StackServer(Socket socket, WaitLimit wait, const RecordLimits& records = {}, const TurnLimits& turns = {});

  /// Declares a topic that the simulator can send, or that the stack can publish: before `greet`.
  void declare(const std::string& topic, const std::string& type) { stream_.declare_known(topic, type); }
  /// Declares a topic with a type that the program does not know.
  void declare(const std::string& topic, const std::string& type, const std::string& definition) {
    stream_.declare(topic, type, definition);
  }
  /// Sends the hello and returns the answer of the stack.
  const HelloReply& greet(const Hello& hello);

  /// Adds a message to the next turn, unless the stack does not want its topic. `is_early`: whether messages of at
  /// least kEarlyBytes are sent at once, without waiting for the stack.
  void send(const std::string& topic, Time log_time, std::string_view cdr, bool is_early);
  /// Lets the stack begin its turn.
  void begin_turn(Time now, bool is_last);
  /// Waits for the end of the turn. The stack has its time from this call on, besides the time since `begin_turn`.
  TurnAnswer end_turn();
  TurnAnswer turn(Time now, bool is_last) {
    begin_turn(now, is_last);
    return end_turn();
  }
  /// Tells the stack why the connection ends. Throws nothing.
  void fail(const std::string& text) noexcept;

  int peer_process() const { return stream_.peer_process(); }

 private:
  RecordStream stream_;
  TurnLimits limits_;
  HelloReply reply_;
  std::set<std::string> wanted_;  ///< empty: all
  Turn turn_;                     ///< last one
};

}  // namespace patrol::link
