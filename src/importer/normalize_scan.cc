#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "importer/normalizer.h"

namespace patrol::importer {

/// Chooses the settings of the leveled scan for a lidar near the ground.
void Normalizer::choose_scan_band() {
  const auto lidar = std::ranges::find(result_.links, "lidar", &NormalizedLink::name);
  if (lidar == result_.links.end() || !lidar->joint) return;
  // The firmware of legs stands at 0.7 of their length.
  constexpr double kStance = 0.7;
  const bool has_legs = result_.drive == DriveType::kLegs;
  const double ground_m = has_legs ? -kStance * result_.leg_m : ground_m_;
  const double height_m = lidar->joint->T_parent_link.position.z() - ground_m;
  double radius_m = 0.0;
  for (const auto& [name, T_root_link] : T_root_link_) {
    const SourceLink& link = source_.link(name);
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape))
        radius_m = std::max(radius_m, (T_base(name) * point).head<2>().norm());
    }
  }
  result_.scan_band = scan_band_of(height_m, radius_m);
  if (!result_.scan_band) return;
  assume("lidar",
         fmt::format("is {:.2f} m above the ground: its hits are obstacles above {:.2f} m (default {:.2f} m), and it "
                     "ignores them within {:.2f} m of the middle of the robot (default {:.2f} m)",
                     height_m, result_.scan_band->min_height_m, kDefaultMinHitHeight_m,
                     result_.scan_band->self_filter_radius_m, kDefaultSelfFilterRadius_m),
         fmt::format("stack.scan_leveling in {}.yaml", result_.name));
}

/// Chooses the distance of a robot with steered wheels from keep-out lines such as curbs, from the smaller side of its
/// outline.
void Normalizer::choose_keep_out_margin(double width_m) {
  // As models/cart, whose discs are 0.17 m from its sides and which keeps 0.30 m. The default is 0.2 m.
  constexpr double kBeside_m = 0.13, kDefault_m = 0.2, kMax_m = 1.0;
  const double disc_m = 0.25 * width_m;  // from the centers of two rows of discs to the side
  result_.keep_out_margin_m = std::clamp(std::floor(100.0 * (disc_m + kBeside_m)) / 100.0, kDefault_m, kMax_m);
  assume("keep-out lines",
         fmt::format("stay {:.2f} m from the centers of the discs of its outline, and so {:.2f} m from its sides",
                     result_.keep_out_margin_m, result_.keep_out_margin_m - disc_m),
         fmt::format("stack.navigation.costmap.keep_out_margin_m in {}.yaml", result_.name));
}

}  // namespace patrol::importer
