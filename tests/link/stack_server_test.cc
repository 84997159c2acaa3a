#include "link/stack_server.h"

#include <functional>
#include <future>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/logs/topics.h"
#include "link/link_error.h"
#include "link/stack_client.h"
#include "tests/link/connected_pair.h"

namespace patrol::link {
namespace {

using namespace std::chrono_literals;
using test::connected_pair;
using test::HandClock;
using testing::ElementsAre;
using testing::HasSubstr;

const Hello kHello{.program = "patrol test",
                   .scenario = "street/short",
                   .seed = 12345678901234567890ULL,
                   .tick = 2ms,
                   .robot = "<robot/>",
                   .site = "{}",
                   .documents = "world: street\n"};

/// Runs a stack in a thread beside the simulator's side, and returns the text of the simulator's error.
std::string run_both(const std::function<void(StackServer&)>& simulator, const std::function<void(Socket)>& stack,
                     std::chrono::milliseconds timeout = 5s, const TurnLimits& limits = {}) {
  auto [server_end, client_end] = connected_pair();
  std::thread other([&stack, end = std::move(client_end)]() mutable {
    try {
      stack(std::move(end));
    } catch (const LinkError&) {}  // the simulator has closed the connection
  });
  std::string text;
  {
    StackServer server(std::move(server_end), {.timeout = timeout}, {}, limits);
    try {
      simulator(server);
    } catch (const LinkError& error) {
      text = error.what();
    }
  }
  other.join();
  return text;
}

/// Stack that takes turns at a period and publishes a velocity command in each.
void drive(Socket socket, Time period, int num_turns) {
  StackClient client(std::move(socket));
  client.begin("driver", {"/imu"}, period);
  for (int i = 0; i < num_turns; ++i) {
    const ReceivedTurn turn = client.next_turn();
    client.publish(turn.now, VelocityCommand{.stamp = turn.now, .vx_mps = 0.5});
    client.done({.now = turn.now, .next_turn = {}, .mission_is_over = i + 1 == num_turns});
  }
}

TEST(StackServer, HelloCarriesTheDocumentsAndTheAnswerTheStacksName) {
  const std::string error = run_both(
      [](StackServer& server) {
        const HelloReply& reply = server.greet(kHello);
        EXPECT_EQ(reply.stack, "driver");
        EXPECT_THAT(reply.topics, ElementsAre("/imu"));
        EXPECT_EQ(reply.turn_period, 50ms);
      },
      [](Socket socket) {
        StackClient client(std::move(socket));
        EXPECT_EQ(client.hello().seed, kHello.seed);
        EXPECT_EQ(client.hello().tick, 2ms);
        EXPECT_EQ(client.hello().documents, kHello.documents);
        client.begin("driver", {"/imu"}, 50ms);
      });
  EXPECT_EQ(error, "");
}

TEST(StackServer, TurnDeliversWantedMessagesAndReturnsWhatTheStackPublishes) {
  const std::string error = run_both(
      [](StackServer& server) {
        server.declare("/imu", io::kRosType<Imu>);
        server.declare("/gas", io::kRosType<GasReading>);
        server.greet(kHello);
        server.send("/imu", 10ms, io::encode(Imu{.stamp = 9ms}), false);
        server.send("/gas", 10ms, io::encode(GasReading{}), false);  // the stack does not want it
        const TurnAnswer answer = server.turn(10ms, false);
        ASSERT_EQ(answer.messages.size(), 1U);
        EXPECT_EQ(answer.messages[0].topic, "/cmd_vel");
        EXPECT_EQ(answer.messages[0].type, "geometry_msgs/msg/TwistStamped");
        EXPECT_EQ(io::decode<VelocityCommand>(answer.messages[0].cdr).vx_mps, 0.5);
        EXPECT_EQ(answer.next_turn, 60ms);  // by the period
        EXPECT_TRUE(answer.mission_is_over);
      },
      [](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("driver", {"/imu"}, 50ms);
        const ReceivedTurn turn = client.next_turn();
        ASSERT_EQ(turn.messages.size(), 1U);
        EXPECT_EQ(turn.messages[0].topic, "/imu");
        EXPECT_EQ(io::decode<Imu>(turn.messages[0].cdr).stamp, 9ms);
        client.publish(turn.now, VelocityCommand{.stamp = turn.now, .vx_mps = 0.5});
        client.done({.now = turn.now, .next_turn = {}, .mission_is_over = true});
      });
  EXPECT_EQ(error, "");
}

TEST(StackServer, AMessageOf8KibibytesArrivesBeforeTheTurnIfItIsSentEarly) {
  for (const bool is_early : {true, false}) {
    std::promise<Time> arrival;
    std::future<Time> has_arrived = arrival.get_future();
    const std::string error = run_both(
        [&](StackServer& server) {
          server.declare("/scan", io::kRosType<LaserScan>);
          server.greet(kHello);
          LaserScan scan;
          scan.ranges_m.assign(kEarlyBytes / sizeof(float), 1.0F);
          server.send("/scan", 10ms, io::encode(scan), is_early);
          const auto wait = is_early ? std::chrono::milliseconds(10s) : 50ms;
          EXPECT_EQ(has_arrived.wait_for(wait) == std::future_status::ready, is_early);
          server.turn(20ms, false);
        },
        [&](Socket socket) {
          StackClient client(std::move(socket));
          client.begin("driver", {}, 50ms);
          const ReceivedTurn turn =
              client.next_turn([&](const DeliveredMessage& message) { arrival.set_value(message.log_time); });
          client.done({.now = turn.now, .next_turn = {}, .mission_is_over = true});
        });
    EXPECT_EQ(error, "");
    EXPECT_EQ(has_arrived.get(), 10ms);
  }
}

TEST(StackServer, AnEarlyMessageLargerThanTheConnectionHoldsArrivesWhole) {
  LaserScan scan;
  for (int i = 0; i < 2'000'000; ++i) scan.ranges_m.push_back(static_cast<float>(i));
  const std::string cdr = io::encode(scan);
  const std::string error = run_both(
      [&](StackServer& server) {
        server.declare("/scan", io::kRosType<LaserScan>);
        server.greet(kHello);
        for (int i = 0; i < 3; ++i) server.send("/scan", 10ms, cdr, true);
        server.turn(20ms, false);
      },
      [&](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("driver", {}, 50ms);
        std::this_thread::sleep_for(20ms);  // the connection fills
        const ReceivedTurn turn = client.next_turn();
        ASSERT_EQ(turn.messages.size(), 3U);
        for (const DeliveredMessage& message : turn.messages) EXPECT_TRUE(message.cdr == cdr);
        client.done({.now = turn.now, .next_turn = {}, .mission_is_over = true});
      });
  EXPECT_EQ(error, "");
}

TEST(StackServer, TenThousandTurnsInOrder) {
  constexpr int kTurns = 10'000;
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        Time now{};
        for (int i = 0; i < kTurns; ++i) {
          const TurnAnswer answer = server.turn(now, false);
          ASSERT_EQ(answer.next_turn, now + 20ms);
          now = answer.next_turn;
        }
      },
      [](Socket socket) { drive(std::move(socket), 20ms, kTurns); });
  EXPECT_EQ(error, "");
}

TEST(StackServer, RefusesAnotherVersionOfTheProtocol) {
  Hello future = kHello;
  future.protocol = 2;
  std::string stack_error;
  const std::string error = run_both([&](StackServer& server) { server.greet(future); },
                                     [&](Socket socket) {
                                       try {
                                         StackClient client(std::move(socket));
                                       } catch (const LinkError& refused) {
                                         stack_error = refused.what();
                                       }
                                     });
  EXPECT_EQ(stack_error, "version 2 of the protocol: must be 1");
  EXPECT_EQ(error, "version 2 of the protocol: must be 1");  // told by the stack
}

TEST(StackServer, ASilentStackIsATimeout) {
  const auto start = std::chrono::steady_clock::now();
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        server.turn({}, false);
      },
      [](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("sleeper", {}, 50ms);
        client.next_turn();
        client.next_turn();  // until the simulator gives up
      },
      300ms);
  EXPECT_EQ(error, "no answer within 0.3 s");
  EXPECT_GE(std::chrono::steady_clock::now() - start, 300ms);
}

TEST(StackServer, AStackThatKeepsPublishingHasNoMoreTimeThanASilentOne) {
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        server.turn({}, false);
      },
      [](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("talker", {}, 50ms);
        client.next_turn();
        while (true) {  // until the simulator gives up
          client.publish({}, VelocityCommand{});
          client.flush();
          std::this_thread::sleep_for(20ms);
        }
      },
      300ms, {.num_messages = 1'000'000});
  EXPECT_EQ(error, "no answer within 0.3 s");
}

TEST(StackServer, TheTimeOfTheSimulatorIsNotThatOfTheStack) {
  HandClock clock;
  auto [server_end, client_end] = connected_pair();
  std::promise<void> is_waited_for;
  bool is_late = false;
  StackServer server(std::move(server_end), {.timeout = 1s,
                                             .is_interrupted =
                                                 [&] {
                                                   if (std::exchange(is_late, false)) is_waited_for.set_value();
                                                   return false;
                                                 },
                                             .clock = clock.reader()});
  std::thread other([&, end = std::move(client_end)]() mutable {
    StackClient client(std::move(end));
    client.begin("driver", {}, 20ms);
    const ReceivedTurn turn = client.next_turn();
    is_waited_for.get_future().wait();
    client.done({.now = turn.now, .next_turn = {}, .mission_is_over = true});
  });
  server.greet(kHello);
  server.begin_turn(10ms, false);
  clock.now += 1h;  // the simulator steps through a delay
  is_late = true;
  EXPECT_NO_THROW(EXPECT_TRUE(server.end_turn().mission_is_over));
  if (std::exchange(is_late, false)) is_waited_for.set_value();
  other.join();
}

TEST(StackServer, AClosedConnectionIsNoticedAtOnce) {
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        server.turn({}, false);
      },
      [](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("leaver", {}, 50ms);
      });
  EXPECT_EQ(error, "connection closed");
}

TEST(StackServer, RefusesAnAnswerToAnotherTurnAndATurnInThePast) {
  const auto answer_with = [](const Done& done) {
    return run_both(
        [](StackServer& server) {
          server.greet(kHello);
          server.turn(100ms, false);
        },
        [&](Socket socket) {
          StackClient client(std::move(socket));
          client.begin("confused", {}, 50ms);
          client.next_turn();
          client.done(done);
          client.next_turn();
        });
  };
  EXPECT_THAT(answer_with({.now = 50ms, .next_turn = 150ms}), HasSubstr("end of the turn at 0.050000000 s"));
  EXPECT_THAT(answer_with({.now = 100ms, .next_turn = 100ms}), HasSubstr("must be after the turn at 0.100000000 s"));
}

TEST(StackServer, LimitsTheMessagesOfATurn) {
  const auto publish = [](int num_messages, const TurnLimits& limits) {
    return run_both(
        [](StackServer& server) {
          server.greet(kHello);
          server.turn({}, false);
        },
        [&](Socket socket) {
          StackClient client(std::move(socket));
          client.begin("talker", {}, 50ms);
          client.next_turn();
          for (int i = 0; i < num_messages; ++i) client.publish({}, VelocityCommand{});
          client.done({});
        },
        5s, limits);
  };
  EXPECT_EQ(publish(5, {.num_messages = 5}), "");
  EXPECT_THAT(publish(6, {.num_messages = 5}), HasSubstr("more than 5 messages"));
  EXPECT_THAT(publish(6, {.num_messages = 100, .bytes = 300}), HasSubstr("300 bytes in one turn"));
}

TEST(StackServer, TheTextOfAFailureReachesTheOtherSide) {
  std::string stack_error;
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        server.fail("command is not finite");
        server.turn({}, false);
      },
      [&](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("unlucky", {}, 50ms);
        try {
          client.next_turn();
        } catch (const LinkError& failure) {
          stack_error = failure.what();
        }
        client.fail("division by zero\nin line 3");
      });
  EXPECT_EQ(stack_error, "command is not finite");
  EXPECT_EQ(error, "division by zero\\nin line 3");  // one line
}

TEST(StackServer, TheTextOfAFailureIsCutBetweenTwoCharacters) {
  std::string umlauts;
  for (int i = 0; i < 500; ++i) umlauts += "ä";
  const std::string error = run_both(
      [](StackServer& server) {
        server.greet(kHello);
        server.turn({}, false);
      },
      [&](Socket socket) {
        StackClient client(std::move(socket));
        client.begin("unlucky", {}, 50ms);
        client.next_turn();
        client.fail("a" + umlauts);
      });
  EXPECT_EQ(error, "a" + umlauts.substr(0, 398));  // 399 of at most 400 bytes
}

// The simulator notices by its next messages that the stack has gone; the reason is already there to be read.
TEST(StackServer, TheTextOfAStackThatHasAlreadyClosedIsRead) {
  auto [server_end, client_end] = connected_pair();
  StackServer server(std::move(server_end), {.timeout = 5s});
  std::thread other([end = std::move(client_end)]() mutable {
    StackClient client(std::move(end));
    client.begin("unlucky", {}, 50ms);
    client.publish(Time{}, VelocityCommand{});
    client.fail("division by zero");
  });
  server.greet(kHello);
  other.join();
  EXPECT_THAT([&] { server.turn({}, false); }, testing::ThrowsMessage<LinkError>("division by zero"));
}

TEST(StackServer, AnInterruptEndsTheWait) {
  auto [server_end, client_end] = connected_pair();
  StackServer server(std::move(server_end), {.timeout = 1h, .is_interrupted = [] { return true; }});
  try {
    server.greet(kHello);
    FAIL() << "no error";
  } catch (const LinkError& error) {
    EXPECT_EQ(error.fault(), LinkFault::kInterrupted);
  }
}

}  // namespace
}  // namespace patrol::link
