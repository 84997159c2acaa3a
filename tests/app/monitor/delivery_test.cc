#include "app/monitor/delivery.h"

#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "monitor/http_server.h"
#include "monitor/queries.h"
#include "monitor/service.h"
#include "monitor/store.h"
#include "tests/monitor/sample_results.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::delivery_test {
namespace {

using namespace patrol::test;

constexpr const char* kToken = "0123456789abcdef";

/// A platform in this process.
class LivePlatform {
 public:
  explicit LivePlatform(const std::filesystem::path& folder, int port = 0)
      : store_(folder),
        service_(store_, kToken, [](const std::string&) {}),
        server_({.port = port, .max_body_mb = 0.01}, service_, [](const std::string&) {}),
        thread_([this] { server_.run(); }) {}
  ~LivePlatform() {
    server_.stop();
    thread_.join();
  }
  LivePlatform(const LivePlatform&) = delete;
  LivePlatform& operator=(const LivePlatform&) = delete;

  int port() const { return server_.port(); }
  MonitorServer monitor_server(const std::string& token = kToken) const {
    return {.url = {.host = "127.0.0.1", .port = std::to_string(port())}, .token = token};
  }

 private:
  monitor::Store store_;
  monitor::Service service_;
  monitor::HttpServer server_;
  std::thread thread_;
};

std::size_t num_kept(const std::filesystem::path& folder) {
  monitor::Store store(folder);
  auto row = store.database().prepare("SELECT count(*) FROM results");
  row.step();
  return static_cast<std::size_t>(row.integer(0));
}

class DeliveryTo : public testing::Test {
 protected:
  void add(int from, int to) {
    for (int i = from; i < to; ++i) outbox_.add(pose_result(i));
  }
  TemporaryFolder run_, data_;
  Outbox outbox_{run_.path()};
};

TEST_F(DeliveryTo, APlatformThatIsThereEmptiesTheOutbox) {
  {
    const LivePlatform server(data_.path());
    Delivery delivery(outbox_, server.monitor_server());
    add(0, 30);
    delivery.wake();
    EXPECT_TRUE(delivery.wait_until_empty(20.0));
    EXPECT_EQ(outbox_.num_pending(), 0U);
  }
  EXPECT_EQ(num_kept(data_.path()), 30U);
}

TEST_F(DeliveryTo, APlatformThatIsAwayGetsAllWhenItIsBack) {
  int port = 0;
  { port = LivePlatform(data_.path()).port(); }
  {
    Delivery delivery(outbox_, {.url = {.host = "127.0.0.1", .port = std::to_string(port)}, .token = kToken});
    add(0, 30);
    delivery.wake();
    EXPECT_FALSE(delivery.wait_until_empty(0.6));
    EXPECT_EQ(delivery.last_error(), "Connection refused");
    EXPECT_EQ(outbox_.num_pending(), 30U);
    const LivePlatform back(data_.path(), port);
    EXPECT_TRUE(delivery.wait_until_empty(20.0));
  }
  EXPECT_EQ(num_kept(data_.path()), 30U);
}

TEST_F(DeliveryTo, ResultsWhoseAnswerWasLostAreKnown) {
  const LivePlatform server(data_.path());
  add(0, 3);
  Sender sender(outbox_, server.monitor_server());
  const Outbox::Batch batch = outbox_.next(10, 10'000);
  EXPECT_EQ(sender.send_next(), Sender::Outcome::kSent);
  outbox_.mark_sent({.results = {}, .end = 0});  // as if the answer had never come
  EXPECT_EQ(sender.send_next(), Sender::Outcome::kSent);
  EXPECT_EQ(sender.send_next(), Sender::Outcome::kEmpty);
  EXPECT_EQ(outbox_.num_rejected(), 0U);
  EXPECT_EQ(batch.results.size(), 3U);
}

TEST_F(DeliveryTo, AWrongTokenKeepsAllInTheOutbox) {
  const LivePlatform server(data_.path());
  add(0, 3);
  Sender sender(outbox_, server.monitor_server("another-0123456789"));
  EXPECT_EQ(sender.send_next(), Sender::Outcome::kInvalidToken);
  EXPECT_EQ(sender.last_error(), "401 invalid token");
  EXPECT_EQ(outbox_.num_pending(), 3U);
}

TEST_F(DeliveryTo, WhatIsRefusedForGoodIsSetAsideAndTheRestArrives) {
  {
    const LivePlatform server(data_.path());
    add(0, 5);
    monitor::Result wrong = pose_result(5);
    wrong.kind = "rumour";
    outbox_.add(wrong);
    outbox_.add(event_result(6, "note", std::string(150, 'x')));
    outbox_.add(event_result(7, "note", std::string(15'000, 'x')));  // above this platform's limit
    add(8, 12);
    Sender sender(outbox_, server.monitor_server());
    for (int i = 0; i < 50 && sender.send_next() == Sender::Outcome::kSent; ++i) {}
    EXPECT_EQ(outbox_.num_pending(), 0U);
    EXPECT_EQ(outbox_.num_rejected(), 2U);
  }
  EXPECT_EQ(num_kept(data_.path()), 10U);
}

TEST_F(DeliveryTo, AConflictIsSetAside) {
  const LivePlatform server(data_.path());
  outbox_.add(pose_result(0, 1.0));
  outbox_.add(pose_result(0, 2.0));
  Sender sender(outbox_, server.monitor_server());
  while (sender.send_next() == Sender::Outcome::kSent) {}
  EXPECT_EQ(outbox_.num_rejected(), 1U);
  EXPECT_EQ(nlohmann::json::parse(read_bytes(run_ / "outbox.refused.jsonl"))["data"]["x"], 2.0);
}

TEST(PlatformFrom, NeedsATokenThatIsOne) {
  ::unsetenv("PATROL_TOKEN");
  EXPECT_THROW(make_monitor_server("http://a", std::nullopt), InputError);
  EXPECT_THROW(make_monitor_server("http://a", "/absent/token"), InputError);
  EXPECT_THROW(make_monitor_server("a", std::nullopt), InputError);
  ::setenv("PATROL_TOKEN", kToken, 1);
  EXPECT_EQ(make_monitor_server("http://a", std::nullopt).token, kToken);
  ::unsetenv("PATROL_TOKEN");
}

}  // namespace
}  // namespace patrol::app::delivery_test
