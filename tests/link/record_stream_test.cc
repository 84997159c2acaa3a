#include "link/record_stream.h"

#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/mcap/mcap_format.h"
#include "link/link_error.h"
#include "tests/link/connected_pair.h"

namespace patrol::link::record_stream_test {
namespace {

using namespace std::chrono_literals;
using test::connected_pair;
using test::HandClock;

TEST(RecordStream, AMessageThatHasArrivedIsReadHoweverLate) {
  auto [near_end, far_end] = connected_pair();
  HandClock clock{.step = 1h};  // every reading of the clock is after the time of the wait
  RecordStream near_side(std::move(near_end), {.timeout = 1s, .clock = clock.reader()});
  RecordStream far_side(std::move(far_end), {});
  far_side.write_control(10ms, Done{.now = 10ms});
  far_side.flush();
  near_side.restart_wait();
  EXPECT_EQ(control_message<Done>(near_side.read()).now, 10ms);
  EXPECT_THAT([&] { near_side.read(); }, testing::ThrowsMessage<LinkError>("no answer within 1 s"));
}

TEST(RecordStream, RecordsThatAreNoMessagesDoNotExtendTheTime) {
  auto [near_end, far_end] = connected_pair();
  std::thread other([end = std::move(far_end)]() mutable {
    io::mcap::RecordWriter start, record;
    io::mcap::write_start(start);
    record.record(io::mcap::kStatistics, {});
    std::string block;
    for (int i = 0; i < 10'000; ++i) block += record.view();
    try {
      end.send(start.view(), {.timeout = 1h});
      while (true) end.send(block, {.timeout = 1h});
    } catch (const LinkError&) {}  // the other side has closed the connection
  });
  HandClock clock{.step = 1h};
  {
    RecordStream near_side(std::move(near_end), {.timeout = 1s, .clock = clock.reader()}, {.record_bytes = 1000});
    EXPECT_THAT([&] { near_side.read(); }, testing::ThrowsMessage<LinkError>("no answer within 1 s"));
  }
  other.join();
}

}  // namespace
}  // namespace patrol::link::record_stream_test
