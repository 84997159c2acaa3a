#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patrol::app {

/// The call of `patrol test`.
struct TestOptions {
  std::filesystem::path scenarios;     ///< a folder, or one scenario
  std::vector<std::string> overrides;  ///< "path=value", in every scenario
  int jobs = 0;                        ///< runs at a time; 0: one for each core
  double run_limit_s = 3600.0;         ///< wall time of a run
  std::string keep = "failed";
  std::filesystem::path out = "out/test";
};

}  // namespace patrol::app
