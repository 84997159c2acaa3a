#include "link/record_stream.h"

#include <utility>

#include <fmt/format.h>

#include "io/files/one_line.h"
#include "io/ros/ros_definitions.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

constexpr std::size_t kReceiveBytes = std::size_t{64} << 10;
constexpr std::size_t kMaxTextBytes = 400;  ///< maximum length of another program's text in a message

}  // namespace

RecordStream::RecordStream(Socket socket, WaitLimit wait, const RecordLimits& limits)
    : socket_(std::move(socket)), wait_(std::move(wait)), max_record_bytes_(limits.record_bytes), parser_(limits) {
  io::mcap::write_start(unsent_);
}

void RecordStream::declare(const std::string& topic, const std::string& type, const std::string& definition) {
  const auto [known_schema, is_new_schema] =
      schemas_.emplace(std::pair(type, definition), static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new_schema) io::mcap::write_schema(unsent_, known_schema->second, type, definition);
  const auto [known, is_new] = channels_.emplace(topic, static_cast<std::uint16_t>(channels_.size() + 1));
  if (is_new) io::mcap::write_channel(unsent_, known->second, known_schema->second, topic);
}

void RecordStream::declare_known(const std::string& topic, const std::string& type) {
  declare(topic, type, io::ros_definition(type));
}

void RecordStream::write(const std::string& topic, Time log_time, std::string_view cdr) {
  io::mcap::write_message(unsent_, channels_.at(topic), 0, static_cast<std::uint64_t>(log_time.count()), cdr);
}

void RecordStream::flush() {
  try {
    socket_.send(unsent_.view().substr(num_sent_), wait_);
  } catch (const LinkError& error) {
    if (error.fault() == LinkFault::kClosed) throw_last_failure();
    throw;
  }
  unsent_.clear();
  num_sent_ = 0;
}

void RecordStream::flush_ready() noexcept { num_sent_ += socket_.send_ready(unsent_.view().substr(num_sent_)); }

void RecordStream::throw_last_failure() {
  try {
    while (true) read();
  } catch (const LinkError& error) {
    if (error.fault() == LinkFault::kInvalid) throw;
  }
}

io::McapMessage RecordStream::read() {
  std::size_t num_bytes = 0;
  while (true) {
    if (const std::optional<io::McapMessage> message = parser_.next()) {
      if (message->channel.topic != kControlTopic<Failure>) return *message;
      const auto failure = control_message<Failure>(*message);
      throw LinkError(LinkFault::kInvalid, io::on_one_line(io::first_bytes(failure.text, kMaxTextBytes)));
    }
    // Bytes that have arrived are read before the time is judged, but not without end: they may be no message.
    if (num_bytes > max_record_bytes_ && wait_.remaining().count() <= 0) wait_.fail("no answer");
    char* const room = parser_.prepare(kReceiveBytes);
    std::size_t size = socket_.receive_ready(room, kReceiveBytes);
    if (size == 0) {
      const SharedCore::Binding binding(core_.get());
      size = socket_.receive(room, kReceiveBytes, wait_);
    }
    parser_.commit(size);
    num_bytes += size;
  }
}

template <typename Message>
Message control_message(const io::McapMessage& message) {
  if (message.channel.topic != kControlTopic<Message>) {
    throw LinkError(LinkFault::kInvalid,
                    fmt::format("message on {} where one on {} is due",
                                io::on_one_line(io::first_bytes(message.channel.topic, kMaxTextBytes)),
                                kControlTopic<Message>));
  }
  try {
    return io::decode<Message>(message.cdr);
  } catch (const io::DecodeError& error) {
    throw LinkError(LinkFault::kInvalid, fmt::format("{}: {}", kControlTopic<Message>, error.what()));
  }
}

template Hello control_message<Hello>(const io::McapMessage&);
template HelloReply control_message<HelloReply>(const io::McapMessage&);
template Turn control_message<Turn>(const io::McapMessage&);
template Done control_message<Done>(const io::McapMessage&);
template Failure control_message<Failure>(const io::McapMessage&);

}  // namespace patrol::link
