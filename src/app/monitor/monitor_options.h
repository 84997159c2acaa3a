#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace patrol::app {

/// What `patrol monitor` was told.
struct MonitorOptions {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::vector<std::string> allowed_hosts;  ///< names under which it is reached, besides its address and `localhost`
  std::filesystem::path data = "out/monitor";
  std::optional<std::filesystem::path> token_file;
};

}  // namespace patrol::app
