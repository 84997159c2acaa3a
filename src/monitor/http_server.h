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

/// Address and limits of the server.
struct HttpServerSettings {
  std::string host = "127.0.0.1";   ///< address or host name to listen on; the default accepts local connections only
  int port = 8080;                  ///< 0: any free port
  double header_timeout_s = 5.0;    ///< timeout from accepting a connection to the end of its first header
  double request_timeout_s = 30.0;  ///< timeout from the end of the header to the end of the response
  double idle_timeout_s = 15.0;     ///< timeout from a response to the end of the next header of the connection
  /// simultaneous connections; a further one closes the one with the longest wait for its header
  int max_connections = 400;
  int max_header_kb = 16;
  double max_body_mb = 8.0;
  double max_bodies_mb = 64.0;     ///< request bodies of all connections; beyond it requests are refused with 503
  double max_responses_mb = 64.0;  ///< unsent responses of all connections; beyond it responses are replaced by 503

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("host", self.host);
    visit("port", self.port, between(0, 65535));
    visit("header_timeout_s", self.header_timeout_s, between(0.1, 600.0));
    visit("request_timeout_s", self.request_timeout_s, between(0.1, 600.0));
    visit("idle_timeout_s", self.idle_timeout_s, between(0.1, 600.0));
    visit("max_connections", self.max_connections, between(1, 900));
    visit("max_header_kb", self.max_header_kb, between(1, 1024));
    visit("max_body_mb", self.max_body_mb, between(0.001, 256.0));
    visit("max_bodies_mb", self.max_bodies_mb, between(0.001, 4096.0));
    visit("max_responses_mb", self.max_responses_mb, between(0.001, 4096.0));
  }
};

/// Parsed request.
struct HttpRequest {
  std::string peer;                                            ///< address of the client
  std::string local;                                           ///< address of the server's end of the connection
  std::string host;                                            ///< Host header; empty unless there is exactly one
  std::string method;                                          ///< GET, POST, ...
  std::string path;                                            ///< path as sent, without the query
  std::map<std::string, std::string, std::less<>> parameters;  ///< decoded query parameters
  std::string authorization;                                   ///< Authorization header
  std::string body;
};

/// Response to a request.
struct HttpResponse {
  int status = 200;
  std::string type = "application/json";  ///< Content-Type
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// Builds an error response: {"error": "one line"}.
HttpResponse error_response(int status, const std::string& reason);

/// Interface of the request handler. Called for one request at a time.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  /// Checks the header before the body is read. Returns an error response, or none to accept the request.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& head) = 0;
  /// Handles a request. An exception becomes a response with status 500.
  virtual HttpResponse answer(const HttpRequest& request) = 0;
};

/// Single-threaded asynchronous HTTP/1.1 server for untrusted networks. Timeouts, header, body and connection counts
/// are bounded (HttpServerSettings).
class HttpServer {
 public:
  using Log = std::function<void(const std::string& line)>;

  /// Opens the port. Throws InputError when the address is not available or a setting is invalid. `log` receives one
  /// line per refused or aborted request.
  HttpServer(const HttpServerSettings& settings, HttpHandler& handler, Log log);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// Serves until SIGINT, SIGTERM or `stop`. `stop` is thread-safe.
  void run();
  void stop();

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

}  // namespace patrol::monitor
