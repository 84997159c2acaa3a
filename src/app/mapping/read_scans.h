#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"
#include "io/logs/scan_log.h"

namespace patrol::app {

/// Calls `use` for every scan of a log in order, and shows the progress in a terminal, labeled `name`. Returns false if
/// `guard` was interrupted.
template <typename Use>
bool read_scans(io::ScanLog& log, const std::string& name, const InterruptGuard& guard, ProgressBar& bar, Use&& use) {
  const double start_s = wall_seconds();
  std::optional<Time> first;
  while (std::optional<RecordedScan> recorded = log.next()) {
    if (!first) first = recorded->scan.stamp;
    const double duration_s = to_seconds(recorded->scan.stamp - *first);
    use(*recorded);
    bar.show(fmt::format("{}  {:3.0f} %  {} scans  {:.0f} times real time", name, 100.0 * log.progress(),
                         log.summary().num_scans, duration_s / std::max(1e-3, wall_seconds() - start_s)),
             log.progress());
    if (guard.is_interrupted()) return false;
  }
  return true;
}

}  // namespace patrol::app
