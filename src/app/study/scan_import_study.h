#pragma once

#include "studies/study.h"

namespace patrol::app {

/// Closed loop of the import of sites from panoramic scans: scans of the tunnel and of the substation with a person and
/// a truck in one of them, the sites of their points alone, and ranges at held-out poses in site and world.
studies::Study scan_import_study();

}  // namespace patrol::app
