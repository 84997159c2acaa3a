#include "monitor/http_client.h"

#include <chrono>
#include <utility>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

namespace patrol::monitor {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::uint64_t kMaxResponseBytes = 16'000'000;

asio::awaitable<HttpClientResponse> exchange(asio::io_context& context, const Url& url,
                                             const http::request<http::string_body>& request, double timeout_s) {
  beast::tcp_stream stream(context);
  stream.expires_after(std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * timeout_s)));
  asio::ip::tcp::resolver resolver(context);
  const auto endpoints = co_await resolver.async_resolve(url.host, url.port, asio::use_awaitable);
  co_await stream.async_connect(endpoints, asio::use_awaitable);
  // A server that refuses a large request at its header stops reading; its response is readable nevertheless.
  beast::error_code unsent;
  co_await http::async_write(stream, request, asio::redirect_error(asio::use_awaitable, unsent));
  if (unsent == beast::error::timeout) throw boost::system::system_error(unsent);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(kMaxResponseBytes);
  co_await http::async_read(stream, buffer, parser, asio::use_awaitable);
  co_return HttpClientResponse{.status = static_cast<int>(parser.get().result_int()),
                               .body = std::move(parser.get().body())};
}

}  // namespace

std::optional<HttpClientResponse> post_json(const Url& url, const std::string& path, const std::string& token,
                                            const std::string& body, double timeout_s, std::string* reason) {
  http::request<http::string_body> request(http::verb::post, path, 11);
  const std::string host = url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]";
  request.set(http::field::host, fmt::format("{}:{}", host, url.port));
  request.set(http::field::authorization, "Bearer " + token);
  request.set(http::field::content_type, "application/json");
  request.keep_alive(false);
  request.body() = body;
  request.prepare_payload();

  asio::io_context context(1);
  std::optional<HttpClientResponse> answer;
  asio::co_spawn(context, exchange(context, url, request, timeout_s),
                 [&](const std::exception_ptr& failure, HttpClientResponse got) {
                   if (!failure) {
                     answer = std::move(got);
                     return;
                   }
                   try {
                     std::rethrow_exception(failure);
                   } catch (const boost::system::system_error& error) {
                     if (reason != nullptr) *reason = error.code().message();
                   }
                 });
  context.run();
  return answer;
}

}  // namespace patrol::monitor
