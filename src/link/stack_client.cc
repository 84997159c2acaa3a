#include "link/stack_client.h"

#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <sched.h>

#include "core/error.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

/// A stack waits as long as the simulator needs; a simulator that is gone closes the connection.
WaitLimit endless() { return {.timeout = std::chrono::hours(24 * 365)}; }

DeliveredMessage copy_of(const io::McapMessage& message) {
  return {.topic = message.channel.topic, .log_time = message.log_time, .cdr = std::string(message.cdr)};
}

}  // namespace

StackClient::StackClient(Socket socket) : stream_(std::move(socket), endless()) {
  while (true) {
    const io::McapMessage message = stream_.read();
    if (message.channel.topic == kControlTopic<Hello>) {
      hello_ = control_message<Hello>(message);
      break;
    }
    documents_.push_back(copy_of(message));
  }
  if (hello_.protocol != kProtocolVersion) {
    const std::string text = fmt::format("version {} of the protocol: must be {}", hello_.protocol, kProtocolVersion);
    fail(text);
    throw LinkError(LinkFault::kInvalid, text);
  }
}

StackClient StackClient::connect() {
  const char* const path = std::getenv(kSocketVariable);
  if (path == nullptr || *path == '\0') {
    throw InputError(fmt::format("{} is not set: start the stack with patrol run --stack COMMAND, or give an address",
                                 kSocketVariable));
  }
  return connect({.is_unix = true, .path = path});
}

void StackClient::begin(const std::string& stack, const std::vector<std::string>& topics, Time turn_period) {
  stream_.write_control(Time{}, HelloReply{.stack = stack, .topics = topics, .turn_period = turn_period});
  stream_.flush();
}

void StackClient::wait_on_simulator_core() {
  stream_.wait_on_peer_core();
  // A simulator that is interrupted by its stack could be moved to another core.
  const sched_param no_priority{};
  if (::sched_getscheduler(0) == SCHED_OTHER) ::sched_setscheduler(0, SCHED_BATCH, &no_priority);
}

ReceivedTurn StackClient::next_turn() {
  std::vector<DeliveredMessage> messages;
  ReceivedTurn received = next_turn([&](DeliveredMessage message) { messages.push_back(std::move(message)); });
  received.messages = std::move(messages);
  return received;
}

ReceivedTurn StackClient::next_turn(const std::function<void(DeliveredMessage)>& on_message) {
  while (true) {
    const io::McapMessage message = stream_.read();
    if (message.channel.topic == kControlTopic<Turn>) {
      const Turn turn = control_message<Turn>(message);
      return {.now = turn.now, .is_last = turn.is_last, .messages = {}};
    }
    on_message(copy_of(message));
  }
}

void StackClient::done(const Done& done) {
  stream_.write_control(done.now, done);
  stream_.flush();
}

void StackClient::fail(const std::string& text) noexcept {
  try {
    stream_.write_control(Time{}, Failure{text});
    stream_.flush();
  } catch (const std::exception&) {}  // the simulator may be gone
}

}  // namespace patrol::link
