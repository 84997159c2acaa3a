#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Study of navigation in sites that are made of panoramic scans, compared with navigation in the scanned worlds.
studies::Study scan_navigation_study();

}  // namespace patrol::app
