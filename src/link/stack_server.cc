#include "link/stack_server.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "link/delivered_message.h"
#include "link/link_error.h"

namespace patrol::link {

StackServer::StackServer(Socket socket, WaitLimit wait, const RecordLimits& records, const TurnLimits& turns)
    : stream_(std::move(socket), std::move(wait), records), limits_(turns) {}

const HelloReply& StackServer::greet(const Hello& hello) {
  stream_.restart_wait();
  stream_.write_control(Time{}, hello);
  stream_.flush();
  reply_ = control_message<HelloReply>(stream_.read());
  if (reply_.protocol != hello.protocol) {
    throw LinkError(LinkFault::kInvalid,
                    fmt::format("version {} of the protocol: must be {}", reply_.protocol, hello.protocol));
  }
  if (reply_.turn_period < Time{}) throw LinkError(LinkFault::kInvalid, "turn period is negative");
  wanted_ = {reply_.topics.begin(), reply_.topics.end()};
  return reply_;
}

void StackServer::send(const std::string& topic, Time log_time, std::string_view cdr, bool is_early) {
  if (!wanted_.empty() && !wanted_.contains(topic)) return;
  stream_.write(topic, log_time, cdr);
  if (is_early && stream_.unsent_bytes() >= kEarlyBytes) stream_.flush_ready();
}

void StackServer::begin_turn(Time now, bool is_last) {
  turn_ = {.now = now, .is_last = is_last};
  stream_.restart_wait();
  stream_.write_control(now, turn_);
  stream_.flush();
}

TurnAnswer StackServer::end_turn() {
  const auto [now, is_last] = turn_;
  stream_.restart_wait();  // the simulator may have taken its time since the start of the turn
  TurnAnswer answer;
  std::size_t num_bytes = 0;
  while (true) {
    const io::McapMessage message = stream_.read();
    if (message.channel.topic == kControlTopic<Done>) {
      const Done done = control_message<Done>(message);
      if (done.now != now) {
        throw LinkError(LinkFault::kInvalid, fmt::format("end of the turn at {:.9f} s: must be that at {:.9f} s",
                                                         to_seconds(done.now), to_seconds(now)));
      }
      if (done.next_turn != Time{} && done.next_turn <= now && !is_last) {
        throw LinkError(LinkFault::kInvalid, fmt::format("next turn at {:.9f} s: must be after the turn at {:.9f} s",
                                                         to_seconds(done.next_turn), to_seconds(now)));
      }
      const Time by_period = now + std::max(reply_.turn_period, Time{1});
      answer.next_turn = done.next_turn != Time{} ? done.next_turn : by_period;
      answer.mission_is_over = done.mission_is_over;
      return answer;
    }
    num_bytes += message.cdr.size();
    if (answer.messages.size() >= limits_.num_messages || num_bytes > limits_.bytes) {
      throw LinkError(LinkFault::kInvalid, fmt::format("more than {} messages or {} bytes in one turn",
                                                       limits_.num_messages, limits_.bytes));
    }
    answer.messages.push_back({.topic = message.channel.topic,
                               .type = message.channel.type,
                               .definition = message.channel.definition,
                               .cdr = std::string(message.cdr)});
  }
}

void StackServer::fail(const std::string& text) noexcept {
  try {
    stream_.restart_wait();
    stream_.write_control(Time{}, Failure{text});
    stream_.flush();
  } catch (const std::exception&) {}  // the stack may be gone
}

}  // namespace patrol::link
