#include "app/run/route_extent.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "sim/geom_box.h"
#include "sim/mujoco.h"

namespace patrol::app {

void require_stations_near(const Route& route, const mjModel& site) {
  constexpr double kMaxDistance_m = 50.0;
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  Eigen::AlignedBox2d box;
  for (int geom = 0; geom < site.ngeom; ++geom) {
    if (site.geom_type[geom] == mjGEOM_PLANE || site.body_weldid[site.geom_bodyid[geom]] != 0) continue;
    const Eigen::AlignedBox3d part = sim::geom_box(site, *data, geom);
    box.extend(Eigen::AlignedBox2d(part.min().head<2>(), part.max().head<2>()));
  }
  if (box.isEmpty()) return;
  for (const Station& station : route.stations) {
    const Pose2& pose = station.T_route_body;
    if (box.exteriorDistance(pose.position()) <= kMaxDistance_m) continue;
    throw InputError(fmt::format(
        "station {}: ({:g}, {:g}) is outside the site: must be at most {:g} m from x {:.1f} to {:.1f} m, y {:.1f} to "
        "{:.1f} m",
        station.name, pose.x, pose.y, kMaxDistance_m, box.min().x(), box.max().x(), box.min().y(), box.max().y()));
  }
}

}  // namespace patrol::app
