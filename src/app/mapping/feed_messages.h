#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/common/process_cost.h"
#include "app/mapping/log_feeder.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::app {

/// Messages of an MCAP file that a stack can be fed with as they were recorded.
struct RecordedMessages {
  std::vector<io::McapChannel> channels;  ///< channels with their topics for the stack, in ascending topic order
  std::uint64_t num_messages = 0;         ///< number of messages on `channels`
  std::map<std::string, std::uint64_t> left_out;  ///< number of messages by topic: not CDR with a ROS 2 definition
  Time start{};                                   ///< log time of the first of them
  bool is_complete = true;                        ///< false: truncated
};

/// Reads an MCAP file to its end. The name of a topic for the stack is that in the file after "/recorded". Throws
/// InputError if the file is damaged, or has no messages or more than 200 topics of ROS 2.
RecordedMessages find_recorded_messages(const std::filesystem::path& mcap);

/// Feeds a stack with the messages of an MCAP file in their order, unchanged, at their log times, and writes them with
/// the answers to `log_mcap`. The stack has its turns at log times. Throws InputError.
FedAnswers feed_messages(const std::filesystem::path& mcap, const RecordedMessages& recorded,
                         std::unique_ptr<StackPort> stack, const std::filesystem::path& log_mcap,
                         const InterruptGuard& guard);

}  // namespace patrol::app
