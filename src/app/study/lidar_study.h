#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Study "lidar-calibration": fourteen planted settings of a lidar, recovered from its simulated scans.
studies::Study lidar_study();

}  // namespace patrol::app
