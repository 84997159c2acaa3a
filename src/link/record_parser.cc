#include "link/record_parser.h"

#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "io/mcap/mcap_format.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

using io::mcap::RecordReader;

[[noreturn]] void fail(const std::string& text) { throw LinkError(LinkFault::kInvalid, "invalid bytes: " + text); }

}  // namespace

char* RecordParser::prepare(std::size_t size) {
  if (begin_ == end_) begin_ = end_ = 0;
  if (buffer_.size() - end_ < size && begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() - end_ < size) buffer_.resize(end_ + size);
  return buffer_.data() + end_;
}

std::optional<io::McapMessage> RecordParser::next() {
  if (!has_magic_) {
    const std::string_view start(buffer_.data() + begin_, std::min(end_ - begin_, io::mcap::kMagic.size()));
    if (start != io::mcap::kMagic.substr(0, start.size())) fail("the stream does not begin with the magic of MCAP");
    if (start.size() < io::mcap::kMagic.size()) return std::nullopt;
    begin_ += start.size();
    has_magic_ = true;
  }
  while (end_ - begin_ >= io::mcap::kRecordHeadSize) {
    RecordReader head({buffer_.data() + begin_, io::mcap::kRecordHeadSize});
    const auto opcode = head.number<std::uint8_t>();
    const auto size = head.number<std::uint64_t>();
    if (size > limits_.record_bytes)
      fail(fmt::format("record of {} bytes: at most {} are allowed", size, limits_.record_bytes));
    if (end_ - begin_ - io::mcap::kRecordHeadSize < size) break;
    const std::string_view content(buffer_.data() + begin_ + io::mcap::kRecordHeadSize, size);
    begin_ += io::mcap::kRecordHeadSize + size;
    try {
      if (const auto message = read_record(opcode, content)) return message;
    } catch (const io::mcap::FormatError& error) {
      fail(error.what());
    }
  }
  return std::nullopt;
}

std::optional<io::McapMessage> RecordParser::read_record(std::uint8_t opcode, std::string_view content) {
  switch (opcode) {
    case io::mcap::kSchema:
      add_schema(content);
      return std::nullopt;
    case io::mcap::kChannel:
      add_channel(content);
      return std::nullopt;
    case io::mcap::kMessage:
      return message_of(content);
    case io::mcap::kChunk:
      fail("chunk: messages must not be compressed");
    default:
      return std::nullopt;
  }
}

void RecordParser::add_schema(std::string_view content) {
  RecordReader reader(content);
  const auto id = reader.number<std::uint16_t>();
  Schema schema{.type = reader.text(), .definition = {}};
  if (const std::string encoding = reader.text(); encoding != "ros2msg")
    fail(fmt::format("schema {} has the encoding {}: must be ros2msg", id, encoding.substr(0, 40)));
  schema.definition = reader.text();
  if (schemas_.size() >= limits_.num_schemas && !schemas_.contains(id))
    fail(fmt::format("more than {} schemas", limits_.num_schemas));
  schemas_[id] = std::move(schema);
}

void RecordParser::add_channel(std::string_view content) {
  RecordReader reader(content);
  const auto id = reader.number<std::uint16_t>();
  const auto schema = schemas_.find(reader.number<std::uint16_t>());
  if (schema == schemas_.end()) fail(fmt::format("channel {} has an unknown schema", id));
  io::McapChannel channel{.topic = reader.text(), .type = schema->second.type, .definition = schema->second.definition};
  if (const std::string encoding = reader.text(); encoding != "cdr")
    fail(fmt::format("channel {} has the encoding {}: must be cdr", id, encoding.substr(0, 40)));
  if (channels_.size() >= limits_.num_channels && !channels_.contains(id))
    fail(fmt::format("more than {} channels", limits_.num_channels));
  const auto [known, is_new] = channels_.emplace(id, channel);
  if (!is_new && (known->second.topic != channel.topic || known->second.type != channel.type))
    fail(fmt::format("channel {} is declared twice with different contents", id));
}

io::McapMessage RecordParser::message_of(std::string_view content) const {
  RecordReader reader(content);
  const auto id = reader.number<std::uint16_t>();
  reader.number<std::uint32_t>();  // sequence number
  const auto log_time = reader.number<std::uint64_t>();
  reader.number<std::uint64_t>();  // publish time
  const auto channel = channels_.find(id);
  if (channel == channels_.end()) fail(fmt::format("message on channel {}, which is not declared", id));
  if (log_time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    fail(fmt::format("message on {} has the time {} ns", channel->second.topic, log_time));
  return {.channel = channel->second, .log_time = Time{static_cast<std::int64_t>(log_time)}, .cdr = reader.rest()};
}

}  // namespace patrol::link
