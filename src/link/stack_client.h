#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "io/logs/topics.h"
#include "link/delivered_message.h"
#include "link/protocol.h"
#include "link/record_stream.h"

namespace patrol::link {

/// Name of the environment variable with the path of the simulator's socket, set for a stack that Patrol starts.
inline constexpr const char* kSocketVariable = "PATROL_STACK_SOCKET";

/// Turn with the messages that were delivered since the last one.
struct ReceivedTurn {
  Time now{};
  bool is_last = false;
  std::vector<DeliveredMessage> messages;
};

/// Side of the stack of a connection to the simulator. Use: connect; hello; begin; then for each turn: next_turn,
/// publish, done. Throws LinkError.
class StackClient {
 public:
  /// `socket`: connected to the simulator.
  explicit StackClient(Socket socket);
  /// Connects to the socket of kSocketVariable. Throws InputError if the variable is not set.
  static StackClient connect();
  static StackClient connect(const Address& address) { return StackClient(Socket::connect(address)); }

  const Hello& hello() const { return hello_; }
  /// Messages that preceded the hello's answer: transforms of the sensors on /tf_static, and the known map on
  /// /site_map.
  const std::vector<DeliveredMessage>& documents() const { return documents_; }
  /// Answers the hello. `topics`: to receive; empty: all. `turn_period`: 0: one tick of the simulator.
  void begin(const std::string& stack, const std::vector<std::string>& topics, Time turn_period);

  /// Binds the calling thread to the core of the simulator while it waits for messages, and makes it a batch thread
  /// (sched(7)): it begins after the simulator has begun to wait. Turns and the simulator after them then begin sooner.
  /// Between two waits the thread computes on any core. Has no effect on TCP. Not for `stack.compute.model=fixed`,
  /// where the simulator continues beside the turn.
  void wait_on_simulator_core();

  /// Waits for the turn after the last `done`. Ask for no turn after the last one.
  ReceivedTurn next_turn();
  /// As above, but passes each message on as it arrives, possibly before the simulator has begun the turn.
  ReceivedTurn next_turn(const std::function<void(DeliveredMessage)>& on_message);

  template <typename Message>
  void publish(Time now, const Message& message) {
    publish_encoded(now, io::kTopic<Message>, io::kRosType<Message>, io::encode(message));
  }
  /// Publishes an encoded message of a type that the program knows.
  void publish_encoded(Time now, const std::string& topic, const std::string& type, std::string_view cdr) {
    if (!stream_.is_declared(topic)) stream_.declare_known(topic, type);
    stream_.write(topic, now, cdr);
  }
  /// Sends the messages that were published in this turn; `done` does so too.
  void flush() { stream_.flush(); }
  /// Ends the turn at `now`.
  void done(const Done& done);
  /// Tells the simulator why the stack fails. Throws nothing.
  void fail(const std::string& text) noexcept;

 private:
  RecordStream stream_;
  Hello hello_;
  std::vector<DeliveredMessage> documents_;
};

}  // namespace patrol::link
