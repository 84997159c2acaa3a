#include "io/logs/log_compare.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "io/mcap/mcap_reader.h"
#include "io/ros/ros_fields.h"

namespace patrol::io {
namespace {

bool same_bytes(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  if (std::filesystem::file_size(a, ignored) != std::filesystem::file_size(b, ignored)) return false;
  std::ifstream first(a, std::ios::binary), second(b, std::ios::binary);
  return first && second &&
         std::equal(std::istreambuf_iterator<char>(first), {}, std::istreambuf_iterator<char>(second), {});
}

std::string byte_difference(std::string_view was, std::string_view is) {
  if (was.size() != is.size()) return fmt::format("the message has {} bytes, had {}", is.size(), was.size());
  const auto [a, b] = std::mismatch(was.begin(), was.end(), is.begin());
  return fmt::format("byte {} of the message is {:#04x}, was {:#04x}", a - was.begin(), static_cast<unsigned char>(*b),
                     static_cast<unsigned char>(*a));
}

/// Describes the first field that differs, or the first byte if no field does or the message cannot be decoded.
std::string content_difference(const McapMessage& was, const McapMessage& is) {
  try {
    const auto before = ros_fields(was.channel.type, was.channel.definition, was.cdr);
    const auto after = ros_fields(is.channel.type, is.channel.definition, is.cdr);
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
      if (before[i].path != after[i].path || before[i].value != after[i].value) {
        return fmt::format("{} is {}, was {}", after[i].path, after[i].value, before[i].value);
      }
    }
  } catch (const std::exception&) {  // missing or unsupported definition
  }
  return byte_difference(was.cdr, is.cdr);
}

std::optional<LogDifference> message_difference(const McapMessage& was, const McapMessage& is) {
  if (was.channel.topic != is.channel.topic || was.log_time != is.log_time) {
    return LogDifference{
        was.channel.topic, was.log_time,
        fmt::format("the other log has {} at {:.9f} s here", is.channel.topic, to_seconds(is.log_time))};
  }
  if (was.channel.type != is.channel.type) {
    return LogDifference{was.channel.topic, was.log_time,
                         fmt::format("is a {}, was a {}", is.channel.type, was.channel.type)};
  }
  if (was.cdr == is.cdr) return std::nullopt;
  return LogDifference{was.channel.topic, was.log_time, content_difference(was, is)};
}

using TopicFilter = std::function<bool(const std::string& topic)>;

std::optional<McapMessage> next_of(McapReader& reader, const TopicFilter& is_compared) {
  while (std::optional<McapMessage> message = reader.next()) {
    if (!is_compared || is_compared(message->channel.topic)) return message;
  }
  return std::nullopt;
}

/// Returns the next difference between two logs; nullopt when both have ended.
std::optional<LogDifference> next_difference(McapReader& before, McapReader& after, const TopicFilter& is_compared) {
  while (true) {
    const std::optional<McapMessage> was = next_of(before, is_compared), is = next_of(after, is_compared);
    if (!was && !is) return std::nullopt;
    if (!is) return LogDifference{was->channel.topic, was->log_time, "the other log ended before this message"};
    if (!was) return LogDifference{is->channel.topic, is->log_time, "the log ended before this message of the other"};
    if (auto difference = message_difference(*was, *is)) return difference;
  }
}

}  // namespace

std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& rerun,
                                              const TopicFilter& is_compared) {
  McapReader before(log), after(rerun);
  return next_difference(before, after, is_compared);
}

std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& rerun) {
  if (same_bytes(log, rerun)) return std::nullopt;
  McapReader before(log), after(rerun);
  if (auto difference = next_difference(before, after, {})) return difference;
  if (before.is_complete() != after.is_complete()) {
    return LogDifference{
        "", {}, fmt::format("identical messages, but the {} is truncated", after.is_complete() ? "log" : "other log")};
  }
  return LogDifference{"", {}, "identical messages, packed differently"};
}

std::string describe(const LogDifference& difference) {
  if (difference.topic.empty()) return difference.what;
  return fmt::format("{} at {:.9f} s: {}", difference.topic, to_seconds(difference.log_time), difference.what);
}

}  // namespace patrol::io
