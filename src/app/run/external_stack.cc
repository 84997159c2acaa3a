#include "app/run/external_stack.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "app/run/compute_delay.h"
#include "core/error.h"
#include "io/logs/topics.h"
#include "io/ros/ros_messages.h"
#include "link/stack_client.h"

namespace patrol::app {
namespace {

using link::LinkError;
using link::LinkFault;

constexpr std::chrono::seconds kTimeToEnd{2};         ///< time for the exit of the process after the last turn
constexpr std::chrono::milliseconds kTimeToDie{200};  ///< time for the exit of a process whose connection has closed
constexpr Time kStampTolerance = std::chrono::seconds(1);  ///< tolerance of stamps before the start and after the turn

}  // namespace

ExternalStack::ExternalStack(StackDocuments documents, StackConnection connection, stack::StackSettings settings)
    : documents_(std::move(documents)), connection_(std::move(connection)), settings_(std::move(settings)) {
  if (!link::is_address(connection_.command)) {
    start_process();
    connecting_ = std::async(std::launch::async, [this] { connect(); });
    return;
  }
  address_ = link::parse_address(connection_.command);
  if (!address_->is_loopback() && !settings_.allow_network) {
    throw InputError(
        fmt::format("stack.command = {}: address that other machines reach: allowed only with "
                    "stack.allow_network = true",
                    connection_.command));
  }
  if (settings_.compute.model == "measured" && !address_->is_unix) {
    throw InputError(
        fmt::format("stack.compute.model = measured: not possible with stack.command = {}, because the "
                    "process behind a TCP address is unknown: use a Unix socket or a command",
                    connection_.command));
  }
  listener_.emplace(link::Socket::listen(*address_));
  const std::string shown =
      address_->is_unix ? connection_.command : fmt::format("tcp:{}:{}", address_->host, listener_->port());
  connecting_ = std::async(std::launch::deferred, [this, shown] {  // port 0: the system has chosen one
    fmt::print(stderr, "patrol: waiting for a stack at {}\n", shown);
    connect();
  });
}

ExternalStack::~ExternalStack() {
  is_abandoned_ = true;
  connecting_ = {};  // waits for its thread
  const auto time_to_end = server_ ? kTimeToEnd : std::chrono::seconds{0};
  server_.reset();
  close_listener();
  if (!process_) return;
  const bool has_ended = process_->stop(time_to_end);
  if (is_finished_) warn_of_end(has_ended);
}

/// Warns of a process that did not end well after its last turn. The result of the run stands.
void ExternalStack::warn_of_end(bool has_ended) {
  if (has_ended && !process_->has_failed()) return;
  const std::string end =
      has_ended ? process_->end_text() : fmt::format("did not exit within {} s", kTimeToEnd.count());
  std::fputs(fmt::format("patrol: warning: the stack {} after the run; its output: {}\n", end, output_name()).c_str(),
             stderr);  // does not throw, in a destructor
}

/// Returns the place of the output of the process.
std::string ExternalStack::output_name() const {
  return connection_.output_name.empty() ? connection_.output.filename().string() : connection_.output_name;
}

/// Closes the socket for connections, and removes its name.
void ExternalStack::close_listener() {
  std::error_code ignored;
  if (listener_ && address_->is_unix) std::filesystem::remove(address_->path, ignored);
  listener_.reset();
}

/// Waits for the stack, sends it the documents, and waits for its answer.
void ExternalStack::connect() {
  const link::WaitLimit wait{.timeout = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                 std::chrono::duration<double>(settings_.timeout_s)),
                             .is_interrupted = [this] {
                               return is_abandoned_ || (connection_.is_interrupted && connection_.is_interrupted());
                             }};
  server_.emplace(accept(wait), wait);
  close_listener();
  for (const io::TopicInfo& info : io::topic_infos()) {
    if (io::is_stack_input(info.topic) || io::is_stack_output(info.topic)) server_->declare(info.topic, info.type);
  }
  for (const io::McapChannel& channel : documents_.recorded)
    server_->declare(channel.topic, channel.type, channel.definition);
  server_->declare(io::kStaticTransforms.topic, io::kStaticTransforms.type);
  server_->declare(link::kSiteMapTopic, io::kRosType<MapUpdate>);
  server_->send(io::kStaticTransforms.topic, Time{}, documents_.static_transforms, false);
  if (!documents_.known_map.empty()) server_->send(link::kSiteMapTopic, Time{}, documents_.known_map, false);
  warn_of_topics(server_->greet(documents_.hello).topics);
}

void ExternalStack::start_process() {
  link::ProcessSettings start{.words = link::command_words(connection_.command), .environment = documents_.environment};
  link::check_program(start.words.front());
  folder_.emplace("stack");
  address_ = link::Address{.is_unix = true, .path = folder_->path() / "socket"};
  start.environment[link::kSocketVariable] = address_->path;
  if (settings_.memory_limit_mb > 0.0)
    start.memory_bytes = static_cast<std::uint64_t>(std::llround(settings_.memory_limit_mb * 1e6));
  listener_.emplace(link::Socket::listen(*address_));
  process_.emplace(start);
}

/// Waits for the stack. A process that ends without connecting ends the wait.
link::Socket ExternalStack::accept(const link::WaitLimit& wait) {
  const auto has_ended = [&] { return process_ && !process_->is_running(); };
  link::WaitLimit until_end = wait;
  until_end.is_interrupted = [&] { return has_ended() || (wait.is_interrupted && wait.is_interrupted()); };
  try {
    return listener_->accept(until_end);
  } catch (const LinkError&) {
    if (has_ended()) throw LinkError(LinkFault::kClosed, "did not connect");
    throw;
  }
}

/// Waits for the connection before the first message, or before the first turn if there is none.
void ExternalStack::ensure_connected() {
  if (!connecting_.valid()) return;
  if (process_) process_->write_output_to(connection_.output);
  try {
    connecting_.get();
  } catch (const LinkError& error) {
    fail(error, "before the start");
  }
}

std::optional<Time> ExternalStack::known_delay() const { return known_delay_of(settings_.compute); }

void ExternalStack::deliver(link::DeliveredMessage message) {
  ensure_connected();
  if (io::is_stack_input(message.topic)) newest_stamp_ = std::max(newest_stamp_, io::header_of(message.cdr).stamp());
  const bool is_early = known_delay().has_value();  // a measured turn contains the processing of its messages
  server_->send(message.topic, message.log_time, message.cdr, is_early);
}

void ExternalStack::begin_turn(Time now) {
  ensure_connected();
  turn_ = now;
  if (settings_.compute.model == "measured") {
    try {
      cpu_start_s_ = cpu_seconds();
    } catch (const LinkError& error) {
      fail(error, fmt::format("at {:.3f} s", to_seconds(turn_)));
    }
  }
  begin_turn(now, false);
}

void ExternalStack::begin_turn(Time now, bool is_last) {
  turn_ = now;
  const auto start = std::chrono::steady_clock::now();
  try {
    server_->begin_turn(now, is_last);
  } catch (const LinkError& error) {
    fail(error, fmt::format("at {:.3f} s", to_seconds(turn_)));
  }
  wait_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

StackAnswer ExternalStack::end_turn() {
  const auto start = std::chrono::steady_clock::now();
  try {
    link::TurnAnswer received = server_->end_turn();
    wait_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    StackAnswer answer{.messages = {}, .next_turn = received.next_turn, .mission_is_over = received.mission_is_over};
    for (link::PublishedMessage& message : received.messages)
      answer.messages.push_back(checked_message(std::move(message), stamp_range()));
    for (const PublishedMessage& message : answer.messages) {
      warn_of_frame(message);
      warn_of_instrument(message);
      warn_of_subject(message);
    }
    answer.delay = delay_of(settings_.compute, cpu_start_s_ ? cpu_seconds() - *cpu_start_s_ : 0.0);
    return answer;
  } catch (const LinkError& error) {
    fail(error, fmt::format("at {:.3f} s", to_seconds(turn_)));
  }
}

std::vector<PublishedMessage> ExternalStack::finish(Time now) {
  ensure_connected();
  cpu_start_s_.reset();  // the last messages have no delay
  begin_turn(now, true);
  std::vector<PublishedMessage> messages = end_turn().messages;
  is_finished_ = true;
  return messages;
}

/// Throws the error again, with a sentence about the stack.
void ExternalStack::fail(const LinkError& error, const std::string& when) {
  if (error.fault() == LinkFault::kInterrupted) throw error;
  std::string text = fmt::format("the stack failed {}: {}", when, error.what());
  if (error.fault() == LinkFault::kTimeout) text = fmt::format("the stack was silent {}: {}", when, error.what());
  if (error.fault() == LinkFault::kInvalid && server_) server_->fail(error.what());
  if (process_) {
    if (error.fault() == LinkFault::kClosed) {
      const auto deadline = std::chrono::steady_clock::now() + kTimeToDie;
      while (process_->is_running() && std::chrono::steady_clock::now() < deadline) ::usleep(1000);
      if (const std::string end = process_->end_text(); !end.empty()) text = fmt::format("the stack {} {}", end, when);
    }
    text += fmt::format("; its output: {}", output_name());
  }
  throw LinkError(error.fault(), text);
}

/// Stamps that messages of this turn may have. The clock of a sensor may be ahead of the turn. Stamps of a recorded log
/// that is fed unchanged are of any clock.
StampRange ExternalStack::stamp_range() const {
  if (!documents_.recorded.empty()) return {};
  return {.from = -kStampTolerance, .to = std::max(turn_, newest_stamp_) + kStampTolerance};
}

/// Warns of topics that the stack wants to receive and that the simulator never sends.
void ExternalStack::warn_of_topics(const std::vector<std::string>& wanted) const {
  const auto is_sent = [&](const std::string& topic) {
    return io::is_stack_input(topic) || topic == io::kStaticTransforms.topic || topic == link::kSiteMapTopic ||
           std::ranges::any_of(documents_.recorded, [&](const auto& channel) { return channel.topic == topic; });
  };
  for (const std::string& topic : std::set<std::string>(wanted.begin(), wanted.end())) {
    if (is_sent(topic)) continue;
    fmt::print(stderr, "patrol: warning: the stack wants messages on {}: the simulator sends none\n",
               quoted_name(topic));
  }
}

void ExternalStack::warn_of_frame(const PublishedMessage& message) {
  if (!documents_.recorded.empty() || warned_.contains(message.topic)) return;
  const std::optional<std::string> frame = unexpected_frame(message);
  if (!frame) return;
  warned_.insert(message.topic);
  fmt::print(stderr, "patrol: warning: frame of {} is {}: it is taken as {}\n", message.topic, quoted_name(*frame),
             *expected_frame(*message.content));
}

void ExternalStack::warn_of_instrument(const PublishedMessage& message) {
  if (!documents_.unanswered.contains(message.topic) || !warned_.insert(message.topic).second) return;
  fmt::print(stderr, "patrol: warning: command on {} has no effect: the robot has no such instrument\n", message.topic);
}

void ExternalStack::warn_of_subject(const PublishedMessage& message) {
  const Event* event = message.content ? std::get_if<Event>(&*message.content) : nullptr;
  if (event == nullptr || !documents_.subjects) return;
  if (const std::string warning = documents_.subjects->warning_of(*event); !warning.empty())
    fmt::print(stderr, "patrol: warning: {}\n", warning);
}

/// CPU time of the process that has connected, with all its threads, since its start. It may be a child of the process
/// that Patrol started. Throws LinkError if the time cannot be read.
double ExternalStack::cpu_seconds() {
  if (process_) process_->is_running();  // collects a process that has ended: its clock would stand still
  const pid_t id = server_->peer_process();
  if (const std::optional<double> seconds = id > 0 ? link::cpu_seconds_of(id) : std::nullopt) return *seconds;
  throw LinkError(
      LinkFault::kClosed,
      fmt::format("CPU time of the process that connected ({}) cannot be read: stack.compute.model = measured needs it",
                  id));
}

}  // namespace patrol::app
