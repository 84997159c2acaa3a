#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace patrol::app {

/// Options of `patrol monitor`.
struct MonitorOptions {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::vector<std::string> allowed_hosts;  ///< host names of the server besides its address and `localhost`
  std::filesystem::path data_dir = "out/monitor";
  std::optional<std::filesystem::path> token_file;
};

}  // namespace patrol::app
