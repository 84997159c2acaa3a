#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/site_settings.h"

namespace patrol::sim {

/// Class of a geom of a site, by its rules for the ground.
enum class SurfaceClass : std::uint8_t { kGround, kCurb, kByContact, kObstacle };

/// Decides which contacts of the robot are driving or walking instead of collisions, by the rules of the site.
class Ground {
 public:
  Ground(const GroundSettings& settings, const mjModel& model);

  /// Returns the class of a geom. kByContact: each contact decides; kObstacle: moving, an obstacle of the
  /// scenario, or not admitted by a rule.
  SurfaceClass class_of(int geom) const { return classes_[static_cast<std::size_t>(geom)]; }

  /// Returns whether a contact with `geom` is one with the ground. `lowest_m`: height of the robot's lowest contact at
  /// this instant.
  bool is_footing(const mjModel& model, const mjData& data, const mjContact& contact, int geom, double lowest_m) const;

 private:
  GroundSettings settings_;
  std::vector<SurfaceClass> classes_;  ///< [geom]
};

/// Returns whether the pattern matches the whole text; `*` stands for any text.
bool matches(std::string_view pattern, std::string_view text);

}  // namespace patrol::sim
