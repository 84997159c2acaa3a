#include <cstdlib>

#include <fmt/format.h>

#include "app/commands.h"
#include "io/one_line.h"
#include "monitor/http_server.h"
#include "monitor/service.h"
#include "monitor/store.h"
#include "monitor/token.h"

namespace patrol::app {
namespace {

/// One line each, whatever the other side sent.
void log_line(const std::string& text) {
  constexpr std::size_t kLongest = 500;
  fmt::print(stderr, "{} {}\n", monitor::to_utc(monitor::now_ms()), io::on_one_line(text.substr(0, kLongest)));
}

std::string token_for(const MonitorOptions& options) {
  if (options.token_file) return monitor::load_token(*options.token_file);
  if (const char* token = std::getenv("PATROL_TOKEN"); token != nullptr) {
    monitor::check_token("PATROL_TOKEN", token);
    return token;
  }
  return monitor::token_of_folder(options.data);
}

}  // namespace

ExitCode monitor_command(const MonitorOptions& options) {
  monitor::Store store(options.data);
  monitor::Service service(store, token_for(options), log_line);
  monitor::HttpServer server({.host = options.host, .port = options.port}, service, log_line);
  const bool has_own_token = !options.token_file && std::getenv("PATROL_TOKEN") == nullptr;
  fmt::print(stderr, "patrol: monitoring at http://{}:{}/{}\n", options.host, server.port(),
             has_own_token ? fmt::format(", token in {}", (options.data / "token").string()) : "");
  server.run();
  return ExitCode::kDone;
}

}  // namespace patrol::app
