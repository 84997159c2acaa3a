#pragma once

#include <string>

#include "app/campaign/batch/run_batch.h"

namespace patrol::app {

/// Options of the commands that make several runs.
struct BatchOptions {
  int jobs = 0;                    ///< parallel runs; 0: one per core
  double run_timeout_s = 3600.0;   ///< wall-clock limit of a run
  std::string keep_runs = "none";  ///< run directories to keep: none, failed, all
};

/// Converts the options. Throws InputError with the option's name.
BatchSettings batch_settings(const BatchOptions& options);

}  // namespace patrol::app
