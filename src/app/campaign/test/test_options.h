#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign/batch/batch_options.h"

namespace patrol::app {

/// Options of `patrol test`.
struct TestOptions {
  std::filesystem::path scenarios;     ///< a folder, or one scenario file
  std::vector<std::string> overrides;  ///< "path=value", for every scenario
  BatchOptions batch{.keep_runs = "failed"};
  std::filesystem::path out = "out/test";
};

}  // namespace patrol::app
