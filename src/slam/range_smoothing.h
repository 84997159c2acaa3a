#pragma once

#include <vector>

#include "core/sensors/lidar.h"

namespace patrol::slam {

/// Smooths the ranges of a lidar with noise of standard deviation `range_std_m`, by robust local regression
/// [Cleveland79], and returns them, [beam]. Around each beam, a straight surface is fitted to the ranges of its
/// neighbors, with Tukey's biweight against other surfaces. The neighbors are those within 2.5 standard deviations of
/// the beam's end along the arc, at most twelve on each side.
///
/// A range remains as it is without room for two neighbors on each side, with fewer than three ranges on the same
/// surface, or if the surface is more than 3.5 standard deviations away. The errors of neighboring ranges are
/// correlated afterwards.
std::vector<float> smoothed_ranges(const LaserScan& scan, double range_std_m);

}  // namespace patrol::slam
