#include "app/campaign/batch/batch_options.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"
#include "core/named_table.h"
#include "core/text.h"

namespace patrol::app {
BatchSettings batch_settings(const BatchOptions& options) {
  constexpr int kMaxJobs = 1024;
  if (options.jobs < 0 || options.jobs > kMaxJobs) {
    throw InputError(fmt::format("--jobs {}: must be in [0, {}]; 0: one per core", options.jobs, kMaxJobs));
  }
  if (!(options.run_timeout_s > 0.0)) throw InputError("--run-timeout-s: must be greater than 0");
  const auto* keep = find_named(kKeepRuns, options.keep_runs);
  if (keep == nullptr) {
    throw InputError(
        fmt::format("--keep-runs {}: must be one of {}", options.keep_runs, join(names_of(kKeepRuns), ", ")));
  }
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return {.pool = {.num_processes = options.jobs > 0 ? options.jobs : cores, .timeout_s = options.run_timeout_s},
          .keep = keep->value};
}

}  // namespace patrol::app
