#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/campaign/batch/batch_options.h"
#include "app/common/print_result.h"

namespace patrol::app {

/// Options of `patrol test`.
struct TestOptions {
  std::vector<std::filesystem::path> scenarios;  ///< folders and scenario files
  std::vector<std::string> overrides;            ///< "path=value", for every scenario
  std::filesystem::path seed_table;              ///< seed_table.h; empty: the seeds of the scenarios
  std::optional<std::string> calibrate;          ///< seeds to propose expectations from, "N" or "A..B"
  bool write = false;                            ///< write the proposals to the scenarios
  bool widen = false;                            ///< proposals may be wider than the present expectations
  BatchOptions batch{.keep_runs = "failed"};
  std::filesystem::path out;  ///< empty: out/test or out/calibration
  ResultForm form = ResultForm::kText;
};

}  // namespace patrol::app
