#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.h"

namespace patrol::monitor {

struct HttpServerSettings {
  std::string host = "127.0.0.1";  ///< address or host name to listen at; by default only this computer reaches it
  int port = 8080;                 ///< 0: any that is free
  double header_limit_s = 5.0;     ///< from the connection, or the request before, to the end of the header
  double request_limit_s = 30.0;   ///< from the header to the end of the answer
  double idle_limit_s = 15.0;      ///< between the requests of one connection
  int max_connections = 400;       ///< at once; one more, and the one that has waited longest for its header goes
  int max_header_kb = 16;
  double max_body_mb = 8.0;
  double max_bodies_mb = 64.0;     ///< request bodies of all connections together; a request beyond it is refused with 503
  double max_answers_mb = 64.0;    ///< answers of all connections together that wait to be read; one beyond it is replaced by 503

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("host", self.host);
    visit("port", self.port, between(0, 65535));
    visit("header_limit_s", self.header_limit_s, between(0.1, 600.0));
    visit("request_limit_s", self.request_limit_s, between(0.1, 600.0));
    visit("idle_limit_s", self.idle_limit_s, between(0.1, 600.0));
    visit("max_connections", self.max_connections, between(1, 900));
    visit("max_header_kb", self.max_header_kb, between(1, 1024));
    visit("max_body_mb", self.max_body_mb, between(0.001, 256.0));
    visit("max_bodies_mb", self.max_bodies_mb, between(0.001, 4096.0));
    visit("max_answers_mb", self.max_answers_mb, between(0.001, 4096.0));
  }
};

struct HttpRequest {
  std::string peer;           ///< address
  std::string local;          ///< address at which the peer reached the server
  std::string host;           ///< Host header; empty unless there is exactly one
  std::string method;         ///< GET, POST, ...
  std::string path;           ///< as it was sent, without what follows the `?`
  std::map<std::string, std::string, std::less<>> parameters;
  std::string authorization;  ///< that header
  std::string body;
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// Every refusal looks alike: {"error": "one line"}.
HttpResponse refusal(int status, const std::string& why);

/// What the server is there for. One request at a time.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  /// Before the body is read: a refusal, or none.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& head) = 0;
  /// May throw: the answer is then 500, and the server goes on.
  virtual HttpResponse answer(const HttpRequest& request) = 0;
};

/// An HTTP/1.1 server for a network that cannot be trusted to be kind: all connections in one thread, none of which waits for another;
/// a limit on the time and the size of everything.
class HttpServer {
 public:
  using Log = std::function<void(const std::string& line)>;

  /// Listens. Throws InputError when the address cannot be had, or a setting breaks its rule. `log` gets one line for each request
  /// that is refused or given up.
  HttpServer(const HttpServerSettings& settings, HttpHandler& handler, Log log);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// Serves until SIGINT, SIGTERM or `stop`, which any thread may call.
  void run();
  void stop();

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

}  // namespace patrol::monitor
