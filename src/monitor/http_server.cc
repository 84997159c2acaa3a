#include "monitor/http_server.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
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
#include "io/files/one_line.h"
#include "monitor/byte_budget.h"
#include "monitor/url.h"

namespace patrol::monitor {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Error = boost::system::error_code;
using Parser = http::request_parser<http::string_body>;

constexpr std::chrono::milliseconds kAcceptPause{100};  // after running out of file descriptors
constexpr double kLingerLimit_s = 1.0;
constexpr std::size_t kLingerBytes = 1 << 24;

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

std::size_t to_bytes(double megabytes) { return static_cast<std::size_t>(1e6 * megabytes); }

auto into(Error& error) { return asio::redirect_error(asio::use_awaitable, error); }

/// Addresses of both ends of a connection.
struct Ends {
  std::string peer;
  std::string local;
};

std::string text_of(asio::ip::address address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    address = asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
  return address.to_string();
}

Ends ends_of(const asio::ip::tcp::socket& socket) {
  Error error;
  const auto peer = socket.remote_endpoint(error);
  if (error) return {.peer = "?", .local = {}};
  const auto local = socket.local_endpoint(error);
  return {.peer = text_of(peer.address()), .local = error ? "" : text_of(local.address())};
}

HttpRequest head_of(const Parser& parser, const Ends& ends) {
  const auto& message = parser.get();
  HttpRequest head;
  head.peer = ends.peer;
  head.local = ends.local;
  if (message.count(http::field::host) == 1) head.host = std::string(message[http::field::host]);
  head.method = std::string(message.method_string());
  head.authorization = std::string(message[http::field::authorization]);
  split_target(std::string(message.target()), head.path, head.parameters);
  return head;
}

HttpResponse to_error_response(const Error& error) {
  if (error == http::error::header_limit) return error_response(431, "header too large");
  if (error == http::error::body_limit) return error_response(413, "body too large");
  return error_response(400, "invalid HTTP request");
}

/// Error response to a request with ambiguous framing (request smuggling), or with a body where none is allowed.
std::optional<HttpResponse> check_framing(const Parser& parser) {
  const auto& message = parser.get();
  const std::size_t num_codings = message.count(http::field::transfer_encoding);
  if (num_codings > 1 || (num_codings == 1 && !beast::iequals(message[http::field::transfer_encoding], "chunked"))) {
    return error_response(501, "Transfer-Encoding must be chunked, or none");
  }
  if (num_codings == 1 && (message.count(http::field::content_length) > 0 || message.version() != 11)) {
    return error_response(400, "Transfer-Encoding goes neither with Content-Length nor with HTTP/1.0");
  }
  const bool has_body = num_codings > 0 || parser.content_length().value_or(0) > 0;
  const bool is_read = message.method() == http::verb::get || message.method() == http::verb::head;
  if (has_body && is_read)
    return error_response(400, fmt::format("a {} request must have no body", std::string(message.method_string())));
  return std::nullopt;
}

/// Endpoint of an address or a host name, IPv4 preferred. Throws system_error for an unknown name.
asio::ip::tcp::endpoint endpoint_of(asio::io_context& context, const HttpServerSettings& settings) {
  Error error;
  const auto address = asio::ip::make_address(settings.host, error);
  if (!error) return {address, static_cast<unsigned short>(settings.port)};
  asio::ip::tcp::resolver resolver(context);
  const auto found = resolver.resolve(settings.host, std::to_string(settings.port), asio::ip::resolver_base::passive);
  const auto v4 =
      std::find_if(found.begin(), found.end(), [](const auto& one) { return one.endpoint().address().is_v4(); });
  return v4 != found.end() ? v4->endpoint() : found.begin()->endpoint();
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

HttpResponse error_response(int status, const std::string& reason) {
  const nlohmann::json json = {{"error", io::on_one_line(reason)}};
  return {.status = status, .body = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), .headers = {}};
}

class HttpServer::Connections {
 public:
  Connections(const HttpServerSettings& settings, HttpHandler& handler, Log log)
      : settings_(settings),
        handler_(handler),
        log_(std::move(log)),
        bodies_(to_bytes(settings.max_bodies_mb)),
        responses_(to_bytes(settings.max_responses_mb)),
        context_(1),
        acceptor_(context_),
        signals_(context_, SIGINT, SIGTERM) {
    validate(settings, "monitor");
    try {
      const asio::ip::tcp::endpoint endpoint = endpoint_of(context_, settings);
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
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
  /// Member of `waiting_` during the wait for its header, otherwise of `busy_`. The destructor removes it from its
  /// list.
  struct Connection : Ends {
    Connection(beast::tcp_stream&& accepted, std::list<Connection*>& busy)
        : Ends(ends_of(accepted.socket())),
          stream(std::move(accepted)),
          entry(busy.insert(busy.end(), this)),
          list(&busy) {}
    ~Connection() { list->erase(entry); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void move_to(std::list<Connection*>& other) {
      other.splice(other.end(), *list, entry);
      list = &other;
    }

    beast::tcp_stream stream;
    std::list<Connection*>::iterator entry;
    std::list<Connection*>* list;
  };

  /// Writes a log line. An exception of the log must end neither the connection nor the server.
  template <typename... Values>
  void log(fmt::format_string<const Values&...> form, const Values&... values) noexcept {
    try {
      log_(fmt::format(form, values...));
    } catch (...) {  // serve the request without its log line
    }
  }

  asio::awaitable<void> accept() {
    asio::steady_timer pause(context_);
    for (;;) {
      Error error;
      asio::ip::tcp::socket socket = co_await acceptor_.async_accept(into(error));
      if (error) {  // no file descriptors, or connection already closed by the client
        pause.expires_after(kAcceptPause);
        co_await pause.async_wait(into(error));
        continue;
      }
      try {
        if (waiting_.size() + busy_.size() >= static_cast<std::size_t>(settings_.max_connections)) close_slowest();
        asio::co_spawn(context_, serve(std::move(socket)), asio::detached);
      } catch (const std::exception& failure) {  // out of memory for this connection
        log("connection aborted: {}", failure.what());
      }
    }
  }

  /// Closes the connection with the longest wait for its header, otherwise the one with the oldest request. Its
  /// coroutine removes it from the list.
  void close_slowest() {
    Connection* waits = first_open(waiting_);
    Connection* one = waits != nullptr ? waits : first_open(busy_);
    if (one == nullptr) return;
    one->stream.close();
    log("{}: closed as the slowest of too many connections", one->peer);
  }

  static Connection* first_open(const std::list<Connection*>& list) {
    const auto open =
        std::find_if(list.begin(), list.end(), [](Connection* one) { return one->stream.socket().is_open(); });
    return open == list.end() ? nullptr : *open;
  }

  asio::awaitable<void> serve(asio::ip::tcp::socket socket) {
    Connection connection(beast::tcp_stream(std::move(socket)), busy_);
    try {
      beast::flat_buffer buffer(static_cast<std::size_t>(settings_.max_header_kb) * 1024 + 65536);
      double timeout_s = settings_.header_timeout_s;
      while (co_await serve_one(connection, buffer, timeout_s)) timeout_s = settings_.idle_timeout_s;
    } catch (const std::exception& failure) {
      log("{}: request aborted: {}", connection.peer, failure.what());
    }
  }

  /// Serves one request. Returns false at the end of the connection.
  asio::awaitable<bool> serve_one(Connection& connection, beast::flat_buffer& buffer, double timeout_s) {
    Parser parser;
    parser.header_limit(static_cast<std::uint32_t>(settings_.max_header_kb) * 1024);
    parser.body_limit(to_bytes(settings_.max_body_mb));
    const Error error = co_await read_header(connection, buffer, parser, timeout_s);
    if (error == http::error::end_of_stream || error == asio::error::connection_reset ||
        error == asio::error::operation_aborted)
      co_return false;
    if (error == beast::error::timeout) {
      if (parser.got_some() || buffer.size() > 0)
        log("{}: request aborted: incomplete header after {} s", connection.peer, timeout_s);
      co_return false;
    }
    connection.stream.expires_after(milliseconds(settings_.request_timeout_s));
    HttpRequest request = head_of(parser, connection);
    std::optional<HttpResponse> error_reply = error ? to_error_response(error) : check_framing(parser);
    if (!error_reply) error_reply = handler_.refuse(request);
    std::size_t body_bytes = 0;
    if (!error_reply)  // else the header may be incomplete, and its length unknown
      body_bytes = parser.chunked() ? to_bytes(settings_.max_body_mb) : parser.content_length().value_or(0);
    std::optional<ByteBudget::Claim> body_claim = bodies_.claim(body_bytes);
    if (!body_claim) error_reply = busy("too many request bodies");
    if (error_reply) {
      co_await refuse(connection, request, std::move(*error_reply));
      co_return false;
    }
    const bool is_read = co_await read_body(connection, buffer, parser, request);
    if (!is_read || (request.method == "GET" && is_disconnected(connection))) co_return false;

    HttpResponse response = answer(request);
    request.body = std::string();
    body_claim.reset();
    const bool is_sent = co_await send(connection, request, std::move(response), parser.get());
    co_return is_sent;
  }

  asio::awaitable<Error> read_header(Connection& connection, beast::flat_buffer& buffer, Parser& parser,
                                     double timeout_s) {
    Error error;
    connection.move_to(waiting_);
    connection.stream.expires_after(milliseconds(timeout_s));
    co_await http::async_read_header(connection.stream, buffer, parser, into(error));
    connection.move_to(busy_);
    co_return error;
  }

  /// Reads the body into the request. Returns false at the end of the connection.
  asio::awaitable<bool> read_body(Connection& connection, beast::flat_buffer& buffer, Parser& parser,
                                  HttpRequest& request) {
    Error error;
    if (beast::iequals(parser.get()[http::field::expect], "100-continue")) {
      http::response<http::empty_body> go_on(http::status::continue_, parser.get().version());
      co_await http::async_write(connection.stream, go_on, into(error));
    }
    if (!error) co_await http::async_read(connection.stream, buffer, parser, into(error));
    if (error == beast::error::timeout) {
      log("{}: request aborted: {} {}: incomplete body after {} s", connection.peer, request.method, request.path,
          settings_.request_timeout_s);
    }
    if (error == http::error::body_limit || error == http::error::bad_chunk ||
        error == http::error::bad_chunk_extension) {
      co_await refuse(connection, request, to_error_response(error));
    }
    request.body = std::move(parser.get().body());
    co_return !error;
  }

  /// Sends a response. Returns false at the end of the connection.
  asio::awaitable<bool> send(Connection& connection, const HttpRequest& request, HttpResponse response,
                             const Parser::value_type& asked) {
    std::optional<ByteBudget::Claim> claim = responses_.claim(response.body.size());
    if (!claim) {
      response = busy("too many unread responses");
      log_error(request, response);
    }
    Error error;
    auto message = to_message(std::move(response), asked.version(), asked.keep_alive());
    co_await http::async_write(connection.stream, message, into(error));
    if (error == beast::error::timeout) {
      log("{}: request aborted: {} {}: response not read within {} s", connection.peer, request.method, request.path,
          settings_.request_timeout_s);
    }
    co_return !error && message.keep_alive();
  }

  /// True when the client has closed its side; no response is computed for it.
  static bool is_disconnected(Connection& connection) {
    char byte = 0;
    const ssize_t count = ::recv(connection.stream.socket().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
  }

  static HttpResponse busy(const std::string& reason) {
    HttpResponse response = error_response(503, reason + ": try again in a second");
    response.headers.emplace_back("Retry-After", "1");
    return response;
  }

  HttpResponse answer(const HttpRequest& request) {
    HttpResponse response;
    try {
      response = handler_.answer(request);
    } catch (const std::exception& failure) {
      response = error_response(500, failure.what());
    }
    if (response.status >= 400) log_error(request, response);
    return response;
  }

  void log_error(const HttpRequest& request, const HttpResponse& response) {
    log("{} {} {} {}: {}", request.peer, response.status, request.method, request.path, response.body);
  }

  /// Sends an error response and closes the connection. Input is discarded for a limited time; otherwise the client
  /// would not receive the response.
  asio::awaitable<void> refuse(Connection& connection, const HttpRequest& request, HttpResponse response) {
    log_error(request, response);
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
  /// oldest first; destroyed after the connections, which end with the context
  std::list<Connection*> waiting_, busy_;
  ByteBudget bodies_, responses_;
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
