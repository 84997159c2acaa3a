#include "monitor/http_server.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "core/error.h"
#include "monitor/http_client.h"

namespace patrol::monitor::http_server_test {
namespace {

using Clock = std::chrono::steady_clock;

/// Says back how large a body was; posting needs "Bearer key".
class Echo final : public HttpHandler {
 public:
  std::optional<HttpResponse> refuse(const HttpRequest& head) override {
    if (head.method == "POST" && head.authorization != "Bearer key") return error_response(401, "no");
    return std::nullopt;
  }
  HttpResponse answer(const HttpRequest& request) override {
    if (request.path == "/broken") throw std::runtime_error("it broke");
    if (request.path == "/slow") std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (request.path == "/counted") ++num_counted;
    if (request.path == "/large") return {.body = std::string(50'000'000, 'x'), .headers = {}};
    return {.body = std::to_string(request.body.size()), .headers = {}};
  }
  std::atomic<int> num_counted = 0;
};

/// A plain socket, for what no client would send.
class Peer {
 public:
  explicit Peer(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval limit{.tv_sec = 5, .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0)
      throw std::runtime_error("cannot connect");
  }
  ~Peer() { ::close(socket_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool send(const std::string& text) {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  /// All until the other side hangs up.
  std::string rest() {
    std::string text;
    for (char part[4096];;) {
      const ssize_t count = ::recv(socket_, part, sizeof part, 0);
      if (count <= 0) return text;
      text.append(part, static_cast<std::size_t>(count));
    }
  }

 private:
  int socket_;
};

class Server : public testing::Test {
 protected:
  void start(HttpServerSettings settings) {
    settings.port = 0;
    server_ = std::make_unique<HttpServer>(settings, echo_, [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      if (is_log_broken_) throw std::runtime_error("no space left on device");
      log_ += line + "\n";
    });
    thread_ = std::thread([this] { server_->run(); });
  }
  void TearDown() override {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
  }

  int port() const { return server_->port(); }
  std::string log() {
    const std::lock_guard lock(mutex_);
    return log_;
  }
  std::optional<HttpClientResponse> post(const std::string& body, const std::string& token = "key") {
    return post_json({.host = "127.0.0.1", .port = std::to_string(port())}, "/", token, body, 5.0);
  }
  bool is_alive() {
    const auto answer = post("four");
    return answer && answer->status == 200 && answer->body == "4";
  }

  Echo echo_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  std::mutex mutex_;
  std::string log_;
  bool is_log_broken_ = false;
};

constexpr HttpServerSettings kSmall{.header_timeout_s = 0.3,
                                    .request_timeout_s = 0.6,
                                    .idle_timeout_s = 0.5,
                                    .max_connections = 20,
                                    .max_header_kb = 4,
                                    .max_body_mb = 0.01};

TEST_F(Server, AnswersAndKeepsTheConnection) {
  start({});
  Peer peer(port());
  peer.send("GET /a HTTP/1.1\r\nHost: x\r\n\r\nGET /b HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  const std::string text = peer.rest();
  EXPECT_EQ(text.find("HTTP/1.1 200 OK"), 0U);
  EXPECT_NE(text.find("HTTP/1.1 200 OK", 1), std::string::npos);
  EXPECT_NE(text.find("X-Content-Type-Options: nosniff"), std::string::npos);
}

TEST_F(Server, ABodyAboveTheLimitIs413WhetherItSaysItsSizeOrNot) {
  start(kSmall);
  EXPECT_EQ(post(std::string(9'990, 'x'))->body, "9990");
  EXPECT_EQ(post(std::string(20'000, 'x'))->status, 413);
  Peer peer(port());
  std::string chunked = "POST / HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer key\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 4; ++i) chunked += "1000\r\n" + std::string(4096, 'x') + "\r\n";
  peer.send(chunked);
  EXPECT_EQ(peer.rest().find("HTTP/1.1 413 "), 0U);
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, ARefusalComesBeforeTheBody) {
  start(kSmall);
  Peer peer(port());
  peer.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9000\r\n\r\n");  // and nothing of it
  EXPECT_EQ(peer.rest().find("HTTP/1.1 401 "), 0U);
  EXPECT_NE(log().find("127.0.0.1 401 POST /: {\"error\":\"no\"}"), std::string::npos);
}

TEST_F(Server, AHeaderAboveTheLimitIs431) {
  start(kSmall);
  Peer peer(port());
  peer.send("GET / HTTP/1.1\r\nA: " + std::string(5000, 'x') + "\r\n\r\n");
  EXPECT_EQ(peer.rest().find("HTTP/1.1 431 "), 0U);
}

TEST_F(Server, WhatIsNoHttpIs400) {
  start(kSmall);
  for (const char* text : {"hello\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "POST / HTTP/1.1\r\nContent-Length: -5\r\n\r\n",
                           "\x16\x03\x01\x02\r\n\r\n"}) {
    Peer peer(port());
    peer.send(text);
    EXPECT_EQ(peer.rest().find("HTTP/1.1 400 "), 0U) << text;
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, AThrowingHandlerIs500AndTheServerGoesOn) {
  start(kSmall);
  Peer peer(port());
  peer.send("GET /broken HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  const std::string text = peer.rest();
  EXPECT_EQ(text.find("HTTP/1.1 500 "), 0U);
  EXPECT_NE(text.find("it broke"), std::string::npos);
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, WhoTricklesAHeaderOrABodyIsGivenUpInTime) {
  start(kSmall);
  for (const char* begin :
       {"GET / HTTP/1.1\r\n", "POST / HTTP/1.1\r\nAuthorization: Bearer key\r\nContent-Length: 5000\r\n\r\n"}) {
    Peer peer(port());
    const auto from = Clock::now();
    peer.send(begin);
    while (peer.send("A: b\r\n") && Clock::now() - from < std::chrono::seconds(5))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LT(Clock::now() - from, std::chrono::seconds(3));
  }
  EXPECT_NE(log().find("incomplete header after 0.3 s"), std::string::npos);
  EXPECT_NE(log().find("POST /: incomplete body after 0.6 s"), std::string::npos);
}

TEST_F(Server, WhoDoesNotReadItsAnswerIsGivenUpInTime) {
  start(kSmall);
  Peer peer(port());
  peer.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
  for (int i = 0; i < 60 && log().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_NE(log().find("response not read within 0.6 s"), std::string::npos);
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, AHundredSilentPeersKeepNobodyWaiting) {
  HttpServerSettings settings = kSmall;
  settings.header_timeout_s = 60.0;
  start(settings);
  std::vector<std::unique_ptr<Peer>> silent;
  for (int i = 0; i < 100; ++i) {
    silent.push_back(std::make_unique<Peer>(port()));
    silent.back()->send("GET / HT");
  }
  const auto from = Clock::now();
  EXPECT_TRUE(is_alive());
  EXPECT_LT(Clock::now() - from, std::chrono::seconds(1));
  EXPECT_NE(log().find("too many connections"), std::string::npos);
}

TEST_F(Server, BodiesOnTheirWayTogetherHaveALimit) {
  HttpServerSettings settings = kSmall;
  settings.request_timeout_s = 60.0;
  settings.max_bodies_mb = 0.03;
  start(settings);
  const std::string head = "POST / HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer key\r\n";
  std::vector<std::unique_ptr<Peer>> unfinished;
  for (const char* length :
       {"Content-Length: 9000\r\n\r\n", "Content-Length: 9000\r\n\r\n", "Transfer-Encoding: chunked\r\n\r\n"}) {
    unfinished.push_back(std::make_unique<Peer>(port()));
    unfinished.back()->send(head + length);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  Peer peer(port());
  peer.send(head + "Content-Length: 9000\r\n\r\n");
  const std::string text = peer.rest();
  EXPECT_EQ(text.find("HTTP/1.1 503 "), 0U) << text;
  EXPECT_NE(text.find("Retry-After: 1"), std::string::npos);
  EXPECT_TRUE(is_alive());  // four bytes fit
  unfinished.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(post(std::string(9000, 'x'))->body, "9000");  // their share is free again
}

TEST_F(Server, AnswersThatNobodyReadsTogetherHaveALimit) {
  HttpServerSettings settings = kSmall;
  settings.request_timeout_s = 60.0;
  settings.max_responses_mb = 60.0;
  start(settings);
  Peer silent(port());
  silent.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  Peer peer(port());
  peer.send("GET /large HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(peer.rest().find("HTTP/1.1 503 "), 0U);
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, AGetRequestHasNoBody) {
  start(kSmall);
  for (const char* length :
       {"Content-Length: 5\r\n\r\nhello", "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"}) {
    for (const char* method : {"GET", "HEAD"}) {
      Peer peer(port());
      peer.send(std::string(method) + " / HTTP/1.1\r\nHost: x\r\n" + length);
      EXPECT_EQ(peer.rest().find("HTTP/1.1 400 "), 0U) << method << length;
    }
  }
  Peer peer(port());
  peer.send("GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(peer.rest().find("HTTP/1.1 200 "), 0U);
}

TEST_F(Server, AnUnknownTransferCodingIsRefusedAndItsBodyIsNoSecondRequest) {
  start(kSmall);
  for (const char* coding : {"xchunked", "gzip, chunked", "chunked, chunked", "identity", "chunked;a=b",
                             "chunked\r\nTransfer-Encoding: chunked", "chunked\r\nContent-Length: 5"}) {
    Peer peer(port());
    peer.send(std::string("POST / HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer key\r\nTransfer-Encoding: ") + coding +
              "\r\n\r\nGET /second HTTP/1.1\r\nHost: x\r\n\r\n");
    const std::string text = peer.rest();
    EXPECT_TRUE(text.starts_with("HTTP/1.1 501 ") || text.starts_with("HTTP/1.1 400 ")) << coding << ": " << text;
    EXPECT_EQ(text.find("HTTP/1.1 ", 1), std::string::npos) << coding << ": " << text;
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, NothingIsComputedForAPeerThatHasGone) {
  start(kSmall);
  for (int i = 0; i < 10; ++i) {
    Peer peer(port());
    peer.send("GET /slow HTTP/1.1\r\nHost: x\r\n\r\n");
    peer.send("GET /counted HTTP/1.1\r\nHost: x\r\n\r\n");
  }
  EXPECT_TRUE(is_alive());
  EXPECT_EQ(echo_.num_counted, 0);
}

TEST_F(Server, ListensAtAHostName) {
  HttpServerSettings settings = kSmall;
  settings.host = "localhost";
  start(settings);
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, ALogThatThrowsEndsNeitherAConnectionNorTheServer) {
  HttpServerSettings settings = kSmall;
  settings.max_connections = 5;
  settings.header_timeout_s = 60.0;
  start(settings);
  {
    const std::lock_guard lock(mutex_);
    is_log_broken_ = true;
  }
  EXPECT_EQ(post("four", "wrong")->status, 401);
  std::vector<std::unique_ptr<Peer>> silent;
  for (int i = 0; i < 20; ++i) {
    silent.push_back(std::make_unique<Peer>(port()));
    silent.back()->send("GET / HT");
  }
  EXPECT_TRUE(is_alive());
  silent.clear();
  for (int i = 0; i < 20; ++i) {
    Peer peer(port());
    peer.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9000\r\n\r\n");
    EXPECT_EQ(peer.rest().find("HTTP/1.1 401 "), 0U);
  }
  EXPECT_TRUE(is_alive());
}

TEST_F(Server, AnAddressThatIsTakenIsAWrongInput) {
  start({});
  EXPECT_THROW(HttpServer({.port = port()}, echo_, [](const std::string&) {}), InputError);
  EXPECT_THROW(HttpServer({.host = "nowhere"}, echo_, [](const std::string&) {}), InputError);
}

TEST_F(Server, AClientIsToldWhyNobodyAnswers) {
  std::string reason;
  EXPECT_FALSE(post_json({.host = "127.0.0.1", .port = "1"}, "/", "key", "", 2.0, &reason));
  EXPECT_EQ(reason, "Connection refused");
}

}  // namespace
}  // namespace patrol::monitor::http_server_test
