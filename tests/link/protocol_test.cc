#include "link/protocol.h"

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "io/mcap/mcap_format.h"

namespace patrol::link {
namespace {

using namespace std::chrono_literals;

std::string hex(std::string_view bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4];
    text += kDigits[static_cast<unsigned char>(byte) & 15];
  }
  return text;
}

template <typename Message>
std::string encoded_twice(const Message& message) {
  return io::encode(io::decode<Message>(io::encode(message)));
}

TEST(Protocol, MessagesSurviveEncodingAndDecoding) {
  const Hello hello{.program = "patrol 1",
                    .scenario = "a/b",
                    .seed = ~0ULL,
                    .tick = 2ms,
                    .limits = {.forward_mps = 1.0, .backward_mps = 0.5, .sideways_mps = 0.25, .yaw_rate_radps = 2.0},
                    .robot = "<robot/>",
                    .site = "{}",
                    .documents = "x: 1\n"};
  EXPECT_EQ(encoded_twice(hello), io::encode(hello));
  EXPECT_EQ(io::decode<Hello>(io::encode(hello)).seed, ~0ULL);
  EXPECT_EQ(io::decode<Hello>(io::encode(hello)).limits.sideways_mps, 0.25);
  const HelloReply reply{.stack = "s", .topics = {"/a", "/b"}, .turn_period = 1500ms};
  EXPECT_EQ(io::decode<HelloReply>(io::encode(reply)).topics, reply.topics);
  EXPECT_EQ(io::decode<HelloReply>(io::encode(reply)).turn_period, 1500ms);
  const Done done{.now = 3s, .next_turn = 3s + 20ms, .mission_is_over = true};
  EXPECT_EQ(io::decode<Done>(io::encode(done)).next_turn, 3s + 20ms);
  EXPECT_TRUE(io::decode<Done>(io::encode(done)).mission_is_over);
  EXPECT_TRUE(io::decode<Turn>(io::encode(Turn{.now = 1s, .is_last = true})).is_last);
}

// The record of the example in the document.
TEST(Protocol, TheDocumentShowsTheBytesOfTheEndOfATurn) {
  io::mcap::RecordWriter record;
  const std::string cdr = io::encode(Done{.now = 50ms, .next_turn = 100ms, .mission_is_over = false});
  record.record_head(io::mcap::kMessage, 2 + 4 + 8 + 8 + cdr.size());
  record.number(std::uint16_t{3});
  record.number(std::uint32_t{0});
  record.number(std::uint64_t{50'000'000});
  record.number(std::uint64_t{50'000'000});
  record.raw(cdr);

  std::ifstream file(std::string(PATROL_SOURCE_DIR) + "/src/link/README.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  std::string shown;
  const std::regex row("^[0-9a-f]{4}  ((?:[0-9a-f]{2} )+)", std::regex::multiline);
  for (std::sregex_iterator match(document.begin(), document.end(), row), end; match != end; ++match)
    shown += std::regex_replace((*match)[1].str(), std::regex(" "), "");
  EXPECT_EQ(shown, hex(record.view()));
}

}  // namespace
}  // namespace patrol::link
