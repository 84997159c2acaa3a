#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/named_table.h"
#include "sim/mujoco.h"
#include "sim/site_settings.h"

namespace patrol::app {

/// Kind of a surface of a site, by the rules for its ground and by its shape.
enum class SurfaceKind : std::uint8_t { kGround, kCurb, kStep, kWall, kObstacle, kMoving, kUntouchable };

inline constexpr std::array kSurfaceKinds = std::to_array<NamedValue<SurfaceKind>>({
    {SurfaceKind::kGround, "ground", "contacts with it are driving or walking"},
    {SurfaceKind::kCurb, "curb", "ground from above, and at its sides up to the height of a curb"},
    {SurfaceKind::kStep, "step", "at most as high as a step; ground from above, an obstacle at its sides"},
    {SurfaceKind::kWall, "wall", "higher than it is thick"},
    {SurfaceKind::kObstacle, "obstacle", "everything else with contact"},
    {SurfaceKind::kMoving, "moving", "part of a body that moves; never ground"},
    {SurfaceKind::kUntouchable, "no contact", "seen by cameras or lidars only"},
});
static_assert(is_in_order(kSurfaceKinds));

constexpr std::string_view name_of(SurfaceKind kind) { return row_of(kSurfaceKinds, kind).name; }

/// Geoms of one kind.
struct SurfaceGroup {
  int num_geoms = 0;
  int num_lidar = 0;                  ///< number of geoms that are visible to lidars
  std::vector<std::string> examples;  ///< names of the first geoms
};

/// Surfaces of a site and the box around those with contact and an end.
struct SiteSurfaces {
  std::array<SurfaceGroup, kSurfaceKinds.size()> groups;  ///< [SurfaceKind]
  Eigen::Vector3d lower_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper_m = Eigen::Vector3d::Zero();

  const SurfaceGroup& of(SurfaceKind kind) const { return groups[static_cast<std::size_t>(kind)]; }
};

/// Classifies the geoms of a site, without robot and obstacles of a scenario.
SiteSurfaces site_surfaces(const mjModel& site, const sim::GroundSettings& settings);

}  // namespace patrol::app
