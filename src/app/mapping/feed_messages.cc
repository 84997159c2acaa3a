#include "app/mapping/feed_messages.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/common/progress_bar.h"
#include "core/error.h"
#include "link/link_error.h"

namespace patrol::app {
namespace {

constexpr std::size_t kMaxTopics = 200;  ///< a connection has at most 256 channels, those of Patrol among them

bool is_ros2(const io::McapChannel& channel) {
  return channel.message_encoding == "cdr" && channel.schema_encoding == "ros2msg";
}

std::string name_for_stack(const std::string& topic) {
  return (topic.starts_with('/') ? "/recorded" : "/recorded/") + topic;
}

}  // namespace

RecordedMessages find_recorded_messages(const std::filesystem::path& mcap) {
  RecordedMessages recorded;
  std::map<std::string, io::McapChannel> channels;
  const auto add = [&](const io::McapMessage& message) {
    if (!is_ros2(message.channel)) {
      ++recorded.left_out[message.channel.topic];
      return;
    }
    if (recorded.num_messages++ == 0) recorded.start = message.log_time;
    const auto [known, is_new] = channels.try_emplace(name_for_stack(message.channel.topic), message.channel);
    if (!is_new && known->second.definition != message.channel.definition)
      throw InputError(fmt::format("{}: {} has messages of two types", mcap.string(), message.channel.topic));
  };
  recorded.is_complete = io::read_mcap(mcap, add, {.topics = {}, .order = io::McapOrder::kLogTime});
  if (channels.empty())
    throw InputError(mcap.string() + ": contains no message in CDR with a ROS 2 message definition");
  if (channels.size() > kMaxTopics) {
    throw InputError(fmt::format("{}: has {} topics: a stack can be fed with at most {}", mcap.string(),
                                 channels.size(), kMaxTopics));
  }
  for (auto& [name, channel] : channels) {
    channel.topic = name;
    recorded.channels.push_back(std::move(channel));
  }
  return recorded;
}

FedAnswers feed_messages(const std::filesystem::path& mcap, const RecordedMessages& recorded,
                         std::unique_ptr<StackPort> stack, const std::filesystem::path& log_mcap,
                         const InterruptGuard& guard) {
  const double wall_start_s = wall_seconds(), cpu_start_s = process_seconds();
  std::map<std::string, const io::McapChannel*> channels;
  for (const io::McapChannel& channel : recorded.channels) channels[channel.topic] = &channel;
  ProgressBar bar;
  RunOutcome outcome;
  LogFeeder feeder(std::move(stack), log_mcap, {}, recorded.start);
  io::McapReader reader(mcap, {.topics = {}, .order = io::McapOrder::kLogTime});
  try {
    while (const std::optional<io::McapMessage> message = reader.next()) {
      if (guard.is_interrupted()) break;
      if (!is_ros2(message->channel)) continue;
      feeder.advance(message->log_time);
      feeder.deliver(*channels.at(name_for_stack(message->channel.topic)), message->cdr);
      outcome.duration = std::max(outcome.duration, message->log_time - recorded.start);
      bar.show(fmt::format("{}  {:3.0f} %", mcap.filename().string(), 100.0 * reader.progress()), reader.progress());
    }
    if (!guard.is_interrupted()) feeder.finish();
    if (guard.is_interrupted()) outcome.end = RunEnd::kInterrupted;
  } catch (const link::LinkError& error) {
    set_failure(outcome, error);
  }
  outcome.wall_s = wall_seconds() - wall_start_s;
  outcome.cpu_s = process_seconds() - cpu_start_s;
  return feeder.answers(std::move(outcome));
}

}  // namespace patrol::app
