#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/common/temporary_folder.h"
#include "app/run/checked_message.h"
#include "app/run/event_subjects.h"
#include "app/run/stack_port.h"
#include "link/link_error.h"
#include "link/protocol.h"
#include "link/stack_process.h"
#include "link/stack_server.h"
#include "stack/settings/stack_settings.h"

namespace patrol::app {

/// Documents for a stack in another process.
struct StackDocuments {
  link::Hello hello;
  std::map<std::string, std::string> environment;  ///< variables for a process that Patrol starts
  std::string static_transforms;                   ///< encoded message on /tf_static
  std::string known_map;                           ///< encoded message on /site_map; empty: the robot builds a map
  std::vector<io::McapChannel> recorded = {};      ///< topics of a recorded log beside those that Patrol knows
  std::set<std::string> unanswered = {};           ///< topics of commands to instruments that the robot lacks
  std::optional<EventSubjects> subjects = {};  ///< subjects of the scored events; nullopt: not known for a recorded log
};

/// Connection to a stack in another process.
struct StackConnection {
  std::string command;                   ///< command line, or address at which the stack connects
  std::filesystem::path output;          ///< file for the output of a process that Patrol starts
  std::string output_name = {};          ///< place of that output in error texts; empty: the name of the file
  std::function<bool()> is_interrupted;  ///< polled while Patrol waits
};

/// A stack in another process, by the turn protocol (src/link/README.md). Its messages are checked before the log and
/// the simulator get them.
class ExternalStack final : public StackPort {
 public:
  /// Starts the process, and connects to it while the caller continues. A stack at an address is waited for before the
  /// first message. Throws InputError if the command is invalid or the address cannot be used.
  ExternalStack(StackDocuments documents, StackConnection connection, stack::StackSettings settings);
  ~ExternalStack() override;

  void deliver(link::DeliveredMessage message) override;
  void begin_turn(Time now) override;
  StackAnswer end_turn() override;
  std::vector<PublishedMessage> finish(Time now) override;
  std::optional<Time> known_delay() const override;
  bool records_turns() const override { return true; }
  std::map<std::string, double> seconds_by_stage() const override { return {{"stack", wait_s_}}; }

 private:
  void ensure_connected();
  void connect();
  link::Socket accept(const link::WaitLimit& wait);
  void close_listener();
  void start_process();
  void begin_turn(Time now, bool is_last);
  [[noreturn]] void fail(const link::LinkError& error, const std::string& when);
  double cpu_seconds();
  StampRange stamp_range() const;
  void warn_of_topics(const std::vector<std::string>& wanted) const;
  void warn_of_frame(const PublishedMessage& message);
  void warn_of_instrument(const PublishedMessage& message);
  void warn_of_subject(const PublishedMessage& message);
  void warn_of_end(bool has_ended);
  std::string output_name() const;

  StackDocuments documents_;
  StackConnection connection_;
  stack::StackSettings settings_;
  std::optional<link::Address> address_;   ///< address at which the stack connects
  std::optional<link::Socket> listener_;   ///< listening socket until the stack has connected
  std::optional<TemporaryFolder> folder_;  ///< folder of the socket for a process that Patrol starts
  std::optional<link::StackProcess> process_;
  std::optional<link::StackServer> server_;
  Time turn_{};                   ///< last turn
  Time newest_stamp_{};           ///< newest stamp of the delivered messages
  std::set<std::string> warned_;  ///< topics with a warning
  std::optional<double>
      cpu_start_s_;  ///< CPU time of the stack at the start of the turn; nullopt unless it delays the messages
  double wait_s_ = 0.0;
  bool is_finished_ = false;                ///< the stack has ended its last turn
  std::atomic<bool> is_abandoned_ = false;  ///< the run ends before the stack has connected
  std::future<void> connecting_;  ///< wait for the stack to connect; last, because its thread uses the other members
};

}  // namespace patrol::app
