#include "slam/graph/uneven_ground.h"

namespace patrol::slam {
namespace {

/// Minimum tilt of a lidar on a slope (2 degrees), and minimum distance over which it stays tilted there: several
/// periods of a gait, and more than a bump.
constexpr double kSlopeTilt_rad = 0.035, kSlopeLength_m = 2.0;

}  // namespace

void UnevenGround::add(const LevelScan& scan, double moved_m) {
  tilted_m_ = scan.tilt_rad > kSlopeTilt_rad ? tilted_m_ + moved_m : 0.0;
  since_slope_m_ += moved_m;
  if (tilted_m_ < kSlopeLength_m) return;
  has_slope_ = true;
  since_slope_m_ = 0.0;
}

}  // namespace patrol::slam
