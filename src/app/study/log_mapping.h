#pragma once

#include <string>
#include <vector>

#include "app/study/loop_truth.h"
#include "app/study/study_run.h"
#include "core/trajectory.h"

namespace patrol::app {

/// A run's log, mapped by one of slam's methods with its default settings.
struct MappedRun {
  Trajectory T_map_body;
  OccupancyGrid map;
  LoopTruth loops;
  double seconds = 0.0;    ///< of processor time, without the reading
  double memory_mb = 0.0;  ///< the most that the heap grew by, looked at after every 20th scan and at the end
};

MappedRun map_log_of(const StudyRun& run, const std::string& method);

}  // namespace patrol::app
