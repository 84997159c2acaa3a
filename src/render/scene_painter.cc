#include "render/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <cstdint>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/robot_model.h"

namespace patrol::render {
namespace {

Eigen::Vector3d to_eigen(const float v[3]) { return {v[0], v[1], v[2]}; }

Color to_color(const float rgba[4]) {
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f))); };
  return {byte(rgba[0]), byte(rgba[1]), byte(rgba[2])};
}

/// The sun, if the world has one: the first directional light that is not the headlight.
mjvLight* find_sun(mjvScene& scene) {
  for (int i = 0; i < scene.nlight; ++i) {
    mjvLight& light = scene.lights[i];
    if (!light.headlight && light.type == mjLIGHT_DIRECTIONAL) return &light;
  }
  return nullptr;
}

/// The cone of sight: four sides, as unit normals that point inwards, through the eye.
std::array<Eigen::Vector3d, 4> sides_of(const View& view, double aspect) {
  const double half_height = 0.5 * view.field_of_view_rad;
  const double half_width = std::atan(std::tan(half_height) * aspect);
  const Eigen::Vector3d right = view.forward.cross(view.up);
  const auto side = [&](const Eigen::Vector3d& across, double half_angle) -> Eigen::Vector3d {
    return std::sin(half_angle) * view.forward + std::cos(half_angle) * across;
  };
  return {side(right, half_width), side(-right, half_width), side(view.up, half_height),
          side(-view.up, half_height)};
}

}  // namespace

void set_replay_quality(mjModel& view) {
  constexpr double kShadowReach_m = 12.5;
  view.vis.quality.numslices = 16;
  view.vis.quality.numstacks = 10;
  view.vis.quality.numquads = 1;
  view.vis.quality.shadowsize = 2048;
  view.vis.map.shadowclip = static_cast<float>(kShadowReach_m / view.stat.extent);
}

ScenePainter::ScenePainter(const mjModel& view, int width, int height, double extinction_per_m)
    : model_(view),
      data_(sim::make_data(view)),
      offscreen_(view, width, height),
      dust_{extinction_per_m, to_color(view.vis.rgba.fog)},
      shadow_reach_m_(static_cast<double>(view.vis.map.shadowclip) * view.stat.extent) {
  mjv_defaultOption(&options_);
  std::fill(std::begin(options_.geomgroup), std::end(options_.geomgroup), mjtByte{0});
  for (const int group : {sim::kGroupSolid, sim::kGroupEyeOnly, sim::kGroupRobotVisual})
    options_.geomgroup[group] = 1;
  std::fill(std::begin(options_.sitegroup), std::end(options_.sitegroup), mjtByte{0});
  mjv_defaultScene(&scene_);
  mjv_makeScene(&view, &scene_, static_cast<int>(view.ngeom) + 100);
  scene_.flags[mjRND_REFLECTION] = 0;
  scene_.flags[mjRND_HAZE] = 0;
  scene_.flags[mjRND_FOG] = 1;
  mj_forward(&model_, data_.get());
}

ScenePainter::~ScenePainter() { mjv_freeScene(&scene_); }

void ScenePainter::set_state(const SimState& state) {
  const auto num_qpos = static_cast<std::size_t>(model_.nq),
             num_mocap = static_cast<std::size_t>(model_.nmocap);
  if (state.qpos.size() != num_qpos || state.mocap.size() != 7 * num_mocap) {
    throw InputError(fmt::format(
        "a state of {} coordinates and {} poses was logged, the model has {} and {}: the log is of another "
        "world or robot",
        state.qpos.size(), state.mocap.size() / 7, num_qpos, num_mocap));
  }
  std::copy(state.qpos.begin(), state.qpos.end(), data_->qpos);
  for (std::size_t body = 0; body < num_mocap; ++body) {
    const auto pose = state.mocap.begin() + static_cast<std::ptrdiff_t>(7 * body);
    std::copy(pose, pose + 3, data_->mocap_pos + 3 * body);
    std::copy(pose + 3, pose + 7, data_->mocap_quat + 4 * body);
  }
  mj_kinematics(&model_, data_.get());
  mj_comPos(&model_, data_.get());
  mj_camlight(&model_, data_.get());
}

void ScenePainter::draw(const View& view, Frame& frame, std::vector<float>& depth) {
  scene_.camera[0] = scene_.camera[1] = gl_camera(view);
  mjv_updateScene(&model_, data_.get(), &options_, nullptr, nullptr, mjCAT_ALL, &scene_);
  light_around(view);
  drop_unseen(view);
  offscreen_.render(scene_);
  offscreen_.read(frame);
  offscreen_.read_depth(depth);
  add_haze(frame, depth, view, dust_);
}

// The shadow map covers a square around the sun's own place: bring the sun to where one looks. Towards the
// sun the outer quarter of that square is speckled (too small a depth offset there in MuJoCo 3.17), so it
// reaches farther that way.
void ScenePainter::light_around(const View& view) {
  constexpr double kSunDistance_m = 25.0, kTowardsSun = 0.15;
  mjvLight* sun = find_sun(scene_);
  if (sun == nullptr) return let_nearest_lamp_throw_shadows(view);
  const Eigen::Vector3d rays = to_eigen(sun->dir);
  const Eigen::Vector3d on_ground(rays.x(), rays.y(), 0.0);
  const Eigen::Vector3d place =
      view.focus - kSunDistance_m * rays - kTowardsSun * shadow_reach_m_ * on_ground.normalized();
  for (int axis = 0; axis < 3; ++axis) sun->pos[axis] = static_cast<float>(place[axis]);
}

// Underground it is lamps that show what stands on the ground. One of them is what a frame can afford: the nearest, where
// what one looks at is well inside the cone that its shadow map covers. Near the edge of that MuJoCo 3.17 draws speckles.
void ScenePainter::let_nearest_lamp_throw_shadows(const View& view) {
  constexpr double kEdge_deg = 5.0;
  const auto away = [&](const mjvLight& light) {
    return light.headlight ? std::numeric_limits<double>::infinity() : (to_eigen(light.pos) - view.focus).norm();
  };
  mjvLight* const end = scene_.lights + scene_.nlight;
  mjvLight* const lamp = std::ranges::min_element(scene_.lights, end, {}, away);
  if (lamp == end || lamp->headlight) return;
  const double off_axis_rad = std::acos((view.focus - to_eigen(lamp->pos)).normalized().dot(to_eigen(lamp->dir).normalized()));
  const double reach_deg = static_cast<double>(lamp->cutoff * model_.vis.map.shadowscale) - kEdge_deg;
  if (off_axis_rad < reach_deg * std::numbers::pi / 180.0) lamp->castshadow = 1;
}

// Software vertex work is half of a frame: leave out what would be a speck, and what is neither in sight
// nor casts a shadow that could be.
void ScenePainter::drop_unseen(const View& view) {
  const auto sides = sides_of(view, static_cast<double>(offscreen_.width()) / offscreen_.height());
  const mjvLight* sun = find_sun(scene_);
  const auto is_in_sight = [&](const Eigen::Vector3d& center, double radius) {
    return std::ranges::all_of(sides,
                               [&](const Eigen::Vector3d& n) { return n.dot(center - view.eye) > -radius; });
  };
  constexpr double kTooSmall_px = 1.2;  // radius
  const double focal_px = 0.5 * offscreen_.height() / std::tan(0.5 * view.field_of_view_rad);
  const auto is_speck = [&](const Eigen::Vector3d& center, double radius) {
    return focal_px * radius < kTooSmall_px * (center - view.eye).norm();
  };
  const auto may_shade = [&](const Eigen::Vector3d& center, double radius) {
    if (sun == nullptr || scene_.flags[mjRND_SHADOW] == 0) return false;
    const double off_axis = (center - view.focus).cross(to_eigen(sun->dir).normalized()).norm();
    return off_axis < std::numbers::sqrt2 * shadow_reach_m_ + radius;
  };
  mjvGeom* const last = std::remove_if(scene_.geoms, scene_.geoms + scene_.ngeom, [&](const mjvGeom& geom) {
    if (geom.type == mjGEOM_PLANE || geom.type == mjGEOM_HFIELD || geom.modelrbound <= 0.0f) return false;
    const Eigen::Vector3d center = to_eigen(geom.pos);
    if (is_speck(center, geom.modelrbound)) return true;
    return !is_in_sight(center, geom.modelrbound) && !may_shade(center, geom.modelrbound);
  });
  scene_.ngeom = static_cast<int>(last - scene_.geoms);
}

}  // namespace patrol::render
