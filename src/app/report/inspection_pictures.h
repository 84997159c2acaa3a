#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "report/blocks.h"

/// Figures of the tunnel inspection: results of the robot from the log beside the truth of the run.
namespace patrol::app {

/// One heat map per station with a registered scan: the displacement of the lining, unrolled, with the findings, and
/// below each ring its true peak displacement from metrics.json.
std::vector<report::Block> lining_pictures(const RunContents& run);

/// For each station that reports water: the reported and the true bodies as spheres of equal volume, seen from above
/// and from the side, in the frame of the robot at the station.
std::vector<report::Block> water_pictures(const RunContents& run);

}  // namespace patrol::app
