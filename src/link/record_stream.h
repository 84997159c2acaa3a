#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/time.h"
#include "io/mcap/mcap_format.h"
#include "io/ros/ros_messages.h"
#include "link/protocol.h"
#include "link/record_parser.h"
#include "link/shared_core.h"
#include "link/socket.h"

namespace patrol::link {

/// Connection that carries messages in both directions. Throws LinkError when it ends or the other side exceeds the
/// wait.
class RecordStream {
 public:
  RecordStream(Socket socket, WaitLimit wait, const RecordLimits& limits = {});

  /// Declares a topic to the other side. `definition`: ROS 2 message definition with all types that it uses.
  void declare(const std::string& topic, const std::string& type, const std::string& definition);
  bool is_declared(const std::string& topic) const { return channels_.contains(topic); }
  /// Adds a message to those that `flush` sends. Declares the topic of a message of the protocol by itself; any other
  /// topic must have been declared.
  void write(const std::string& topic, Time log_time, std::string_view cdr);
  template <typename Message>
  void write_control(Time log_time, const Message& message) {
    if (!is_declared(kControlTopic<Message>)) declare_known(kControlTopic<Message>, io::kRosType<Message>);
    write(kControlTopic<Message>, log_time, io::encode(message));
  }
  /// Declares a topic with a type that the program knows (io/ros/ros_definitions.h).
  void declare_known(const std::string& topic, const std::string& type);
  /// Sends what the connection takes without waiting, and leaves the rest and all failures to `flush`.
  void flush_ready() noexcept;
  std::size_t unsent_bytes() const { return unsent_.view().size() - num_sent_; }
  /// Sends the messages. Throws the failure of the other side if it sent one and closed the connection.
  void flush();
  /// Begins the time that the other side has for its next answer, of any number of messages.
  void restart_wait() { wait_.restart(); }

  /// Waits for the next message, valid until the next call. A message that has arrived is returned also after the time
  /// of the wait. Throws LinkError (kInvalid) also with the text of a Failure of the other side.
  io::McapMessage read();

  int peer_process() const { return socket_.peer_process(); }

  /// Binds the thread to the core of the other side while it waits for bytes (shared_core.h). Has no effect on TCP.
  void wait_on_peer_core() { core_ = std::make_unique<SharedCore>(peer_process()); }

 private:
  /// Reads what the other side sent before it closed the connection. Throws its failure if it sent one.
  void throw_last_failure();

  Socket socket_;
  WaitLimit wait_;
  std::size_t max_record_bytes_;
  std::unique_ptr<SharedCore> core_;  ///< none: the thread is not bound
  RecordParser parser_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  ///< sent, ids by type and definition
  std::map<std::string, std::uint16_t> channels_;                         ///< ids of the sent channels by topic
  io::mcap::RecordWriter unsent_;
  std::size_t num_sent_ = 0;  ///< first bytes of `unsent_` that were sent without waiting
};

/// Decodes a message of the protocol. Throws LinkError (kInvalid) if the message is another one.
template <typename Message>
Message control_message(const io::McapMessage& message);

}  // namespace patrol::link
