#pragma once

#include <vector>

#include "realism/beam.h"
#include "realism/posed_scan.h"
#include "realism/site.h"

namespace patrol::realism {

/// Casts the beams of a scan without errors, each from the pose of its own instant, [beam]. Surfaces beyond the maximum
/// range of the scan are not expected.
std::vector<ExpectedBeam> expected_beams(const Site& site, const PosedScan& posed, const BeamRules& rules);

/// Returns the beams of a scan with the given ranges, classified, [beam].
std::vector<Beam> beams_of(const PosedScan& posed, const std::vector<ExpectedBeam>& expected,
                           const std::vector<float>& ranges_m, std::uint32_t scan, const BeamRules& rules);

}  // namespace patrol::realism
