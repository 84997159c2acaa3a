#include "render/scene/ghost.h"

#include <algorithm>
#include <cmath>

#include "render/scene/palette.h"

namespace patrol::render {
namespace {

using RowMajor3f = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

/// Planar pose of the robot's base in world.
Pose2 level_pose(const mjData& data, int body) {
  const mjtNum* p = data.xpos + 3 * body;
  const mjtNum* q = data.xquat + 4 * body;
  return {p[0], p[1], to_yaw({q[0], q[1], q[2], q[3]})};
}

void tint(mjvGeom& geom, double opacity) {
  constexpr double kMaxOpacity = 0.32;  // MuJoCo 3.17 blends translucent geoms twice
  geom.category = mjCAT_DECOR;          // casts no shadow
  geom.matid = -1;
  geom.emission = 0.4f;
  geom.specular = geom.shininess = geom.reflectance = 0.0f;
  geom.rgba[0] = static_cast<float>(kEstimateColor.r) / 255.0f;
  geom.rgba[1] = static_cast<float>(kEstimateColor.g) / 255.0f;
  geom.rgba[2] = static_cast<float>(kEstimateColor.b) / 255.0f;
  geom.rgba[3] = static_cast<float>(kMaxOpacity * opacity);
}

}  // namespace

double ghost_opacity(const Pose2& T_true_estimate) {
  constexpr double kInvisibleError_m = 0.04, kOpaqueError_m = 0.12;
  constexpr double kLever_m = 0.5;  // half length of the robot: converts yaw error to displacement
  const double off_m = T_true_estimate.position().norm() + kLever_m * std::abs(T_true_estimate.yaw);
  return std::clamp((off_m - kInvisibleError_m) / (kOpaqueError_m - kInvisibleError_m), 0.0, 1.0);
}

void add_ghost(mjvScene& scene, const mjModel& model, const mjData& data, const Pose2& T_true_estimate) {
  const double opacity = ghost_opacity(T_true_estimate);
  const int robot = mj_name2id(&model, mjOBJ_BODY, frame_id::kBody);
  if (opacity == 0.0 || robot < 0) return;
  const Pose2 T_world_true = level_pose(data, robot);
  const Pose2 T_there_here = T_world_true * T_true_estimate * T_world_true.inverse();
  const RowMajor3f turn = quaternion_from_yaw(T_there_here.yaw).toRotationMatrix().cast<float>();
  for (int i = 0, num_true = scene.ngeom; i < num_true && scene.ngeom < scene.maxgeom; ++i) {
    const mjvGeom& part = scene.geoms[i];
    if (part.objtype != mjOBJ_GEOM || model.body_rootid[model.geom_bodyid[part.objid]] != model.body_rootid[robot])
      continue;
    mjvGeom& ghost = scene.geoms[scene.ngeom++];
    ghost = part;
    const Eigen::Vector2d p_ghost = T_there_here * Eigen::Vector2d(part.pos[0], part.pos[1]);
    ghost.pos[0] = static_cast<float>(p_ghost.x());
    ghost.pos[1] = static_cast<float>(p_ghost.y());
    Eigen::Map<RowMajor3f>(ghost.mat) = turn * Eigen::Map<const RowMajor3f>(part.mat);
    tint(ghost, opacity);
  }
}

}  // namespace patrol::render
