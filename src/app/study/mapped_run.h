#pragma once

#include <string>
#include <vector>

#include "app/study/loop_closure_accuracy.h"
#include "app/study/study_run.h"
#include "core/trajectory.h"

namespace patrol::app {

/// Map of a run's log, built by one of the SLAM methods with its default settings.
struct MappedRun {
  Trajectory T_map_body;
  OccupancyGrid map;
  LoopClosureAccuracy loops;
  double seconds = 0.0;    ///< processor time without reading the log
  double memory_mb = 0.0;  ///< maximum growth of the heap, sampled after every 20th scan and at the end
};

MappedRun map_log_of(const StudyRun& run, const std::string& method);

}  // namespace patrol::app
