#include "monitor/http_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <list>
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/one_line.h"
#include "monitor/url.h"

namespace patrol::monitor {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Error = boost::system::error_code;
using Parser = http::request_parser<http::string_body>;

constexpr std::chrono::milliseconds kAcceptPause{100};  // when there are no more file descriptors
constexpr double kLingerLimit_s = 1.0;
constexpr std::size_t kLingerBytes = 1 << 24;

std::chrono::milliseconds milliseconds(double seconds) { return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds)); }

auto into(Error& error) { return asio::redirect_error(asio::use_awaitable, error); }

HttpRequest head_of(const Parser& parser, const std::string& peer) {
  const auto& message = parser.get();
  HttpRequest head;
  head.peer = peer;
  head.method = std::string(message.method_string());
  head.authorization = std::string(message[http::field::authorization]);
  split_target(std::string(message.target()), head.path, head.parameters);
  return head;
}

HttpResponse refusal_of(const Error& error) {
  if (error == http::error::header_limit) return refusal(431, "the header is too large");
  if (error == http::error::body_limit) return refusal(413, "the body is too large");
  return refusal(400, "this is not an HTTP request");
}

http::response<http::string_body> to_message(HttpResponse&& response, unsigned version, bool keeps_alive) {
  http::response<http::string_body> message(static_cast<http::status>(response.status), version);
  message.set(http::field::content_type, response.type);
  message.set("X-Content-Type-Options", "nosniff");
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.keep_alive(keeps_alive);
  message.body() = std::move(response.body);
  message.prepare_payload();
  return message;
}

}  // namespace

HttpResponse refusal(int status, const std::string& why) {
  const nlohmann::json json = {{"error", io::on_one_line(why)}};
  return {.status = status, .body = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), .headers = {}};
}

class HttpServer::Connections {
 public:
  Connections(const HttpServerSettings& settings, HttpHandler& handler, Log log)
      : settings_(settings), handler_(handler), log_(std::move(log)), context_(1), acceptor_(context_), signals_(context_, SIGINT, SIGTERM) {
    validate(settings, "monitor");
    try {
      const asio::ip::tcp::endpoint place(asio::ip::make_address(settings.host), static_cast<unsigned short>(settings.port));
      acceptor_.open(place.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(place);
      acceptor_.listen(asio::socket_base::max_listen_connections);
    } catch (const boost::system::system_error& error) {
      throw InputError(fmt::format("cannot listen at {}:{}: {}", settings.host, settings.port, error.code().message()));
    }
    signals_.async_wait([this](const Error& error, int) {
      if (!error) context_.stop();
    });
    asio::co_spawn(context_, accept(), asio::detached);
  }

  int port() const { return acceptor_.local_endpoint().port(); }
  void run() { context_.run(); }
  void stop() { context_.stop(); }

 private:
  /// Listed in `waiting_` while its header is awaited, else in `busy_`; in neither once it has ended.
  struct Connection {
    Connection(beast::tcp_stream&& accepted, std::string address, std::list<Connection*>& busy)
        : stream(std::move(accepted)), peer(std::move(address)), place(busy.insert(busy.end(), this)), list(&busy) {}
    ~Connection() { list->erase(place); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void move_to(std::list<Connection*>& other) {
      other.splice(other.end(), *list, place);
      list = &other;
    }

    beast::tcp_stream stream;
    std::string peer;
    std::list<Connection*>::iterator place;
    std::list<Connection*>* list;
  };

  /// Writes a log line. A log that throws must end neither a connection nor the server.
  template <typename... Values>
  void log(fmt::format_string<const Values&...> form, const Values&... values) noexcept {
    try {
      log_(fmt::format(form, values...));
    } catch (...) {  // the request is worth more than its line
    }
  }

  asio::awaitable<void> accept() {
    asio::steady_timer pause(context_);
    for (;;) {
      Error error;
      asio::ip::tcp::socket socket = co_await acceptor_.async_accept(into(error));
      if (error) {  // no descriptors left, or the peer has gone again
        pause.expires_after(kAcceptPause);
        co_await pause.async_wait(into(error));
        continue;
      }
      try {
        if (waiting_.size() + busy_.size() >= static_cast<std::size_t>(settings_.max_connections)) close_one();
        asio::co_spawn(context_, serve(std::move(socket)), asio::detached);
      } catch (const std::exception& failure) {  // no memory for this one
        log("a connection given up: {}", failure.what());
      }
    }
  }

  /// The one that has waited longest for its header, or else has been at its request longest. It takes itself off the lists.
  void close_one() {
    Connection* waits = first_open(waiting_);
    Connection* one = waits != nullptr ? waits : first_open(busy_);
    if (one == nullptr) return;
    one->stream.close();
    log("{} closed: too many connections, and it is the slowest", one->peer);
  }

  static Connection* first_open(const std::list<Connection*>& list) {
    const auto open = std::find_if(list.begin(), list.end(), [](Connection* one) { return one->stream.socket().is_open(); });
    return open == list.end() ? nullptr : *open;
  }

  asio::awaitable<void> serve(asio::ip::tcp::socket socket) {
    Error error;
    const auto endpoint = socket.remote_endpoint(error);
    Connection connection(beast::tcp_stream(std::move(socket)), error ? "?" : endpoint.address().to_string(), busy_);
    try {
      beast::flat_buffer buffer(static_cast<std::size_t>(settings_.max_header_kb) * 1024 + 65536);
      double limit_s = settings_.header_limit_s;
      while (co_await serve_one(connection, buffer, limit_s)) limit_s = settings_.idle_limit_s;
    } catch (const std::exception& failure) {
      log("{} given up: {}", connection.peer, failure.what());
    }
  }

  /// A request and its answer. False: the connection is at its end.
  asio::awaitable<bool> serve_one(Connection& connection, beast::flat_buffer& buffer, double limit_s) {
    Parser parser;
    parser.header_limit(static_cast<std::uint32_t>(settings_.max_header_kb) * 1024);
    parser.body_limit(static_cast<std::uint64_t>(1e6 * settings_.max_body_mb));

    Error error;
    connection.move_to(waiting_);
    connection.stream.expires_after(milliseconds(limit_s));
    co_await http::async_read_header(connection.stream, buffer, parser, into(error));
    connection.move_to(busy_);
    if (error == http::error::end_of_stream || error == asio::error::connection_reset || error == asio::error::operation_aborted) co_return false;
    if (error == beast::error::timeout) {
      if (parser.got_some() || buffer.size() > 0) log("{} given up: no whole header within {} s", connection.peer, limit_s);
      co_return false;
    }
    connection.stream.expires_after(milliseconds(settings_.request_limit_s));
    HttpRequest request = head_of(parser, connection.peer);
    if (error) {
      co_await refuse(connection, request, refusal_of(error));
      co_return false;
    }
    if (std::optional<HttpResponse> refused = handler_.refuse(request)) {
      co_await refuse(connection, request, std::move(*refused));
      co_return false;
    }
    if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
      http::response<http::empty_body> go_on(http::status::continue_, parser.get().version());
      co_await http::async_write(connection.stream, go_on, into(error));
    }
    if (!error) co_await http::async_read(connection.stream, buffer, parser, into(error));
    if (error == beast::error::timeout) {
      log("{} given up: {} {}: no whole body within {} s", connection.peer, request.method, request.path, settings_.request_limit_s);
      co_return false;
    }
    if (error == http::error::body_limit || error == http::error::bad_chunk || error == http::error::bad_chunk_extension) {
      co_await refuse(connection, request, refusal_of(error));
      co_return false;
    }
    if (error) co_return false;  // the peer has gone

    request.body = std::move(parser.get().body());
    HttpResponse response = answer(request);
    auto message = to_message(std::move(response), parser.get().version(), parser.get().keep_alive());
    co_await http::async_write(connection.stream, message, into(error));
    if (error == beast::error::timeout) {
      log("{} given up: {} {}: the answer was not read within {} s", connection.peer, request.method, request.path,
          settings_.request_limit_s);
    }
    co_return !error && message.keep_alive();
  }

  HttpResponse answer(const HttpRequest& request) {
    HttpResponse response;
    try {
      response = handler_.answer(request);
    } catch (const std::exception& failure) {
      response = refusal(500, failure.what());
    }
    if (response.status >= 400) log_refusal(request, response);
    return response;
  }

  void log_refusal(const HttpRequest& request, const HttpResponse& response) {
    log("{} {} {} {}: {}", request.peer, response.status, request.method, request.path, response.body);
  }

  /// Says no and hangs up: what is still coming is thrown away for a moment, or the peer would never see the answer.
  asio::awaitable<void> refuse(Connection& connection, const HttpRequest& request, HttpResponse response) {
    log_refusal(request, response);
    auto message = to_message(std::move(response), 11, false);
    Error error;
    co_await http::async_write(connection.stream, message, into(error));
    connection.stream.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
    connection.stream.expires_after(milliseconds(kLingerLimit_s));
    std::array<char, 65536> waste{};
    for (std::size_t count = 0, more = 1; more > 0 && count < kLingerBytes; count += more) {
      more = co_await connection.stream.async_read_some(asio::buffer(waste), into(error));
      if (error) break;
    }
  }

  HttpServerSettings settings_;
  HttpHandler& handler_;
  Log log_;
  std::list<Connection*> waiting_, busy_;  ///< the longest first; they outlive the connections, which end with the context
  asio::io_context context_;
  asio::ip::tcp::acceptor acceptor_;
  asio::signal_set signals_;
};

HttpServer::HttpServer(const HttpServerSettings& settings, HttpHandler& handler, Log log)
    : connections_(std::make_unique<Connections>(settings, handler, std::move(log))) {}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return connections_->port(); }
void HttpServer::run() { connections_->run(); }
void HttpServer::stop() { connections_->stop(); }

}  // namespace patrol::monitor
