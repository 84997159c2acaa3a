#include <unistd.h>

#include <cstdlib>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "monitor/host_names.h"
#include "monitor/http_server.h"
#include "monitor/line_log.h"
#include "monitor/service.h"
#include "monitor/store.h"
#include "monitor/token.h"

namespace patrol::app {
namespace {

std::string load_access_token(const MonitorOptions& options) {
  if (options.token_file) return monitor::load_token(*options.token_file);
  if (const char* token = std::getenv("PATROL_TOKEN"); token != nullptr) {
    monitor::check_token("PATROL_TOKEN", token);
    return token;
  }
  return monitor::load_or_create_token(options.data_dir);
}

/// Accepted host names from the options, including the host to listen on.
monitor::HostNames hosts_of(const MonitorOptions& options) {
  std::vector<std::string> names = options.allowed_hosts;
  if (!options.host.empty()) names.push_back(options.host);
  return monitor::HostNames(names);
}

}  // namespace

ExitCode monitor_command(const MonitorOptions& options) {
  monitor::ignore_lost_output();
  monitor::LineLog log(STDERR_FILENO);
  const auto log_line = [&log](const std::string& text) { log.write_with_time(text); };
  monitor::Store store(options.data_dir);
  monitor::Service service(store, load_access_token(options), log_line, hosts_of(options));
  monitor::HttpServer server({.host = options.host, .port = options.port}, service, log_line);
  const bool has_own_token = !options.token_file && std::getenv("PATROL_TOKEN") == nullptr;
  log.write(fmt::format("patrol: monitor listening at http://{}:{}/{}", options.host, server.port(),
                        has_own_token ? fmt::format(", token in {}", (options.data_dir / "token").string()) : ""));
  server.run();
  return ExitCode::kDone;
}

}  // namespace patrol::app
