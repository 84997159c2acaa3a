#pragma once

#include "importer/site/points/panorama.h"

namespace patrol::importer {

/// Sets kPixelBlocked for the pixels of gaps without returns that a surface closer than the minimum range of the
/// scanner explains. Such a gap is no evidence that the space behind it is free. Either it reaches 30 degrees below the
/// horizon, where the ground would return the beams. Or at least a tenth of the returns around it have ranges near the
/// minimum, which is the shortest range of the scan if that is below 1.6 m.
void mark_near_gaps(Panorama& scan);

}  // namespace patrol::importer
