#include "link/record_parser.h"

#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mcap/mcap_format.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

using testing::HasSubstr;

std::string magic() { return std::string(io::mcap::kMagic); }

std::string schema(std::uint16_t id, const std::string& type, const std::string& encoding = "ros2msg") {
  io::mcap::RecordWriter content, record;
  content.number(id);
  content.text(type);
  content.text(encoding);
  content.text("float64 x\n");
  record.record(io::mcap::kSchema, content);
  return std::string(record.view());
}

std::string channel(std::uint16_t id, std::uint16_t schema, const std::string& topic,
                    const std::string& encoding = "cdr") {
  io::mcap::RecordWriter content, record;
  content.number(id);
  content.number(schema);
  content.text(topic);
  content.text(encoding);
  content.number(std::uint32_t{0});
  record.record(io::mcap::kChannel, content);
  return std::string(record.view());
}

std::string message(std::uint16_t channel, std::uint64_t log_time, const std::string& cdr) {
  io::mcap::RecordWriter content, record;
  content.number(channel);
  content.number(std::uint32_t{0});
  content.number(log_time);
  content.number(log_time);
  content.raw(cdr);
  record.record(io::mcap::kMessage, content);
  return std::string(record.view());
}

void add(RecordParser& parser, const std::string& bytes) {
  std::memcpy(parser.prepare(bytes.size()), bytes.data(), bytes.size());
  parser.commit(bytes.size());
}

/// Text of the error of a stream.
std::string error_of(const std::string& bytes, const RecordLimits& limits = {}) {
  RecordParser parser(limits);
  add(parser, bytes);
  try {
    while (parser.next()) {}
  } catch (const LinkError& error) {
    EXPECT_EQ(error.fault(), LinkFault::kInvalid);
    return error.what();
  }
  return "";
}

const std::string kStart = magic() + schema(1, "a/msg/B") + channel(7, 1, "/b");

TEST(RecordParser, ReturnsEveryMessageOfAStreamThatArrivesByteByByte) {
  const std::string bytes = kStart + message(7, 20, "one") + message(7, 30, "");
  RecordParser parser;
  std::vector<std::pair<Time, std::string>> received;
  for (const char byte : bytes) {
    add(parser, std::string(1, byte));
    while (const auto one = parser.next()) {
      EXPECT_EQ(one->channel.topic, "/b");
      EXPECT_EQ(one->channel.type, "a/msg/B");
      EXPECT_EQ(one->channel.definition, "float64 x\n");
      received.emplace_back(one->log_time, one->cdr);
    }
  }
  const std::vector<std::pair<Time, std::string>> expected = {{Time{20}, "one"}, {Time{30}, ""}};
  EXPECT_EQ(received, expected);
}

TEST(RecordParser, SkipsRecordsThatAreNoMessages) {
  io::mcap::RecordWriter unknown;
  unknown.record_head(static_cast<io::mcap::Opcode>(0x90), 3);
  unknown.raw("abc");
  RecordParser parser;
  add(parser, kStart + std::string(unknown.view()) + message(7, 1, "x"));
  EXPECT_EQ(parser.next().value().cdr, "x");
  EXPECT_FALSE(parser.next().has_value());
}

TEST(RecordParser, KeepsMemoryWithinOneRecordOfTheNewestBytes) {
  RecordParser parser;
  add(parser, kStart);
  const std::string large = message(7, 1, std::string(100'000, 'x'));
  const char* room = nullptr;
  for (int i = 0; i < 100; ++i) {
    add(parser, large);
    while (parser.next()) {}
    char* const next_room = parser.prepare(large.size());
    if (i > 2) {
      EXPECT_EQ(next_room, room);  // the buffer is used again, not grown
    }
    room = next_room;
  }
}

TEST(RecordParser, RefusesWhatIsNoStreamOfMessages) {
  EXPECT_THAT(error_of("GET / HTTP/1.1"), HasSubstr("does not begin with the magic of MCAP"));
  EXPECT_THAT(error_of(kStart + message(8, 0, "")), HasSubstr("message on channel 8, which is not declared"));
  EXPECT_THAT(error_of(magic() + channel(1, 4, "/x")), HasSubstr("channel 1 has an unknown schema"));
  EXPECT_THAT(error_of(magic() + schema(1, "a/msg/B", "protobuf")), HasSubstr("encoding protobuf: must be ros2msg"));
  EXPECT_THAT(error_of(kStart + channel(9, 1, "/json", "json")), HasSubstr("encoding json: must be cdr"));
  EXPECT_THAT(error_of(kStart + channel(7, 1, "/other")), HasSubstr("declared twice"));
  EXPECT_THAT(error_of(kStart + message(7, ~0ULL, "")), HasSubstr("message on /b has the time"));
  io::mcap::RecordWriter chunk;
  chunk.record_head(io::mcap::kChunk, 0);
  EXPECT_THAT(error_of(magic() + std::string(chunk.view())), HasSubstr("must not be compressed"));
}

TEST(RecordParser, RefusesARecordByItsHeadBeforeItsBytesArrive) {
  io::mcap::RecordWriter head;
  head.record_head(io::mcap::kMessage, 1ULL << 40);
  EXPECT_THAT(error_of(kStart + std::string(head.view())),
              HasSubstr("record of 1099511627776 bytes: at most 67108864"));
}

TEST(RecordParser, LimitsTheNumberOfChannelsAndSchemas) {
  std::string bytes = kStart;
  for (std::uint16_t id = 100; id < 104; ++id) bytes += channel(id, 1, "/b" + std::to_string(id));
  EXPECT_EQ(error_of(bytes, {.num_channels = 5}), "");
  EXPECT_THAT(error_of(bytes, {.num_channels = 4}), HasSubstr("more than 4 channels"));
  EXPECT_THAT(error_of(kStart + schema(2, "c/msg/D"), {.num_schemas = 1}), HasSubstr("more than 1 schemas"));
}

TEST(RecordParser, RefusesARecordWhoseContentIsTooShort) {
  io::mcap::RecordWriter record;
  record.record_head(io::mcap::kMessage, 5);
  record.raw("abcde");
  EXPECT_THAT(error_of(kStart + std::string(record.view())), HasSubstr("a record ends too early"));
}

}  // namespace
}  // namespace patrol::link
