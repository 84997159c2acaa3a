#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Studies of navigation in a site that is made of panoramic scans, compared with navigation in the scanned world: in
/// the tunnel and in the substation.
studies::Study scan_navigation_study();
studies::Study scan_navigation_substation_study();

}  // namespace patrol::app
