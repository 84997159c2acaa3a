#include "sim/nearby_scenery.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "core/frames.h"

namespace patrol::sim {
namespace {

// As measured on the street: smaller cells cost more bodies than they spare contacts.
constexpr double kCell_m = 10.0;
constexpr double kLarge_m = 4.0;  // half length from which a geom would stretch its cell over others
constexpr double kReach_m = 1.5;  // of a robot from its origin, lying on its side with its legs stretched, and a step

bool is_simple(const mjsGeom& geom) {
  return geom.type == mjGEOM_BOX || geom.type == mjGEOM_SPHERE || geom.type == mjGEOM_CAPSULE || geom.type == mjGEOM_CYLINDER ||
         geom.type == mjGEOM_ELLIPSOID;
}

/// Copies what a geom is, but not what belongs to its place in the specification.
void copy_geom(const mjsGeom& from, mjsGeom& to) {
  const mjsGeom own = to;
  to = from;
  to.element = own.element;
  to.material = own.material;
  to.hfieldname = own.hfieldname;
  to.meshname = own.meshname;
  to.userdata = own.userdata;
  to.plugin = own.plugin;
  to.info = own.info;
}

/// Half of the box along the world's axes that holds a geom of a body that stands still, as seen from above.
Eigen::Vector2d half_extent(const mjModel& model, const mjData& data, int geom) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data.geom_xmat + 9 * geom);
  const Eigen::Map<const Eigen::Vector3d> middle(model.geom_aabb + 6 * geom), half(model.geom_aabb + 6 * geom + 3);
  return (R.cwiseAbs() * (middle.cwiseAbs() + half)).head<2>();
}

}  // namespace

void gather_scenery_in_cells(mjSpec& world) {
  mjsBody* root = mjs_findBody(&world, "world");
  std::vector<mjsElement*> movable;
  for (mjsElement* element = mjs_firstChild(root, mjOBJ_GEOM, 0); element != nullptr;
       element = mjs_nextChild(root, element, 0)) {
    if (is_simple(*mjs_asGeom(element)) && mjs_getFrame(element) == nullptr) movable.push_back(element);
  }
  std::map<std::tuple<int, int, bool>, mjsBody*> cells;
  for (mjsElement* element : movable) {
    const mjsGeom& geom = *mjs_asGeom(element);
    const bool has_ends = !std::isnan(geom.fromto[0]);
    const double x = has_ends ? (geom.fromto[0] + geom.fromto[3]) / 2.0 : geom.pos[0];
    const double y = has_ends ? (geom.fromto[1] + geom.fromto[4]) / 2.0 : geom.pos[1];
    const bool is_large = std::max({geom.size[0], geom.size[1], geom.size[2]}) > kLarge_m;
    mjsBody*& cell = cells[{static_cast<int>(std::floor(x / kCell_m)), static_cast<int>(std::floor(y / kCell_m)), is_large}];
    if (cell == nullptr) {
      cell = mjs_addBody(root, nullptr);
      mjs_setName(cell->element, fmt::format("scenery_{}", cells.size()).c_str());
    }
    const std::string name = mjs_getString(mjs_getName(element));
    mjsGeom* moved = mjs_addGeom(cell, nullptr);
    copy_geom(geom, *moved);
    mjs_delete(&world, element);
    if (!name.empty()) mjs_setName(moved->element, name.c_str());
  }
}

NearbyScenery::NearbyScenery(mjModel& physics) : physics_(physics), robot_(mj_name2id(&physics, mjOBJ_BODY, frame_id::kBody)) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&physics), mj_deleteData);
  mj_kinematics(&physics, data.get());
  for (int body = 1; body < physics.nbody; ++body) {
    const bool is_actor = physics.body_mocapid[body] >= 0;
    if ((physics.body_weldid[body] != 0 && !is_actor) || physics.body_geomnum[body] == 0) continue;
    Body entry{.body = body,
               .contype = physics.body_contype[body],
               .conaffinity = physics.body_conaffinity[body],
               .lower = Eigen::Vector2d::Constant(1e9),
               .upper = Eigen::Vector2d::Constant(-1e9),
               .is_moving = is_actor};
    bool is_endless = false;
    for (int i = 0; i < physics.body_geomnum[body]; ++i) {
      const int geom = physics.body_geomadr[body] + i;
      is_endless |= physics.geom_rbound[geom] <= 0.0;
      // An actor turns: whichever way, it stays within the sphere about each geom.
      const Eigen::Vector2d half =
          is_actor ? Eigen::Vector2d::Constant(physics.geom_rbound[geom] + Eigen::Vector3d(physics.geom_pos + 3 * geom).norm())
                   : half_extent(physics, *data, geom);
      const Eigen::Vector2d centre = is_actor ? Eigen::Vector2d::Zero() : Eigen::Vector2d(data->geom_xpos + 3 * geom);
      entry.lower = entry.lower.cwiseMin(centre - half);
      entry.upper = entry.upper.cwiseMax(centre + half);
    }
    if (!is_endless) bodies_.push_back(entry);
  }
}

void NearbyScenery::update(const mjData& data) {
  const Eigen::Vector2d robot(data.xpos + 3 * robot_);
  for (const Body& entry : bodies_) {
    const Eigen::Vector2d place = entry.is_moving ? Eigen::Vector2d(data.xpos + 3 * entry.body) : Eigen::Vector2d::Zero();
    const Eigen::Array2d offset = (robot - place).array();
    const bool is_near = (offset > entry.lower.array() - kReach_m).all() && (offset < entry.upper.array() + kReach_m).all();
    physics_.body_contype[entry.body] = is_near ? entry.contype : 0;
    physics_.body_conaffinity[entry.body] = is_near ? entry.conaffinity : 0;
  }
}

}  // namespace patrol::sim
