#pragma once

#include "core/messages.h"
#include "slam/grid_map.h"
#include "slam/scan_integration_settings.h"

namespace patrol::slam {

/// Integrates a scan taken at `T_map_body` into the map.
void integrate_scan(const LevelScan& scan, const Pose2& T_map_body, const ScanIntegrationSettings& settings,
                    GridMap& map);

}  // namespace patrol::slam
