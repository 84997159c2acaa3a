#pragma once

#include <string>

#include "app/batch/run_batch.h"

namespace patrol::app {

/// How the commands that make many runs are told to make them.
struct BatchOptions {
  int jobs = 0;                 ///< runs at a time; 0: one for each core
  double run_limit_s = 3600.0;  ///< wall time of a run
  std::string keep = "none";    ///< run directories that stay: none, failed, all
};

/// Throws InputError, naming the option.
BatchSettings batch_settings(const BatchOptions& options);

}  // namespace patrol::app
