#include "render/scene/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "core/geometry/angles.h"
#include "render/scene/ghost.h"
#include "render/scene/model_state.h"
#include "sim/robot_model.h"

namespace patrol::render {
namespace {

Eigen::Vector3d to_eigen(const float v[3]) { return {v[0], v[1], v[2]}; }

Color to_color(const float rgba[4]) {
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
  };
  return {byte(rgba[0]), byte(rgba[1]), byte(rgba[2])};
}

/// First directional light other than the headlight, null without one.
mjvLight* find_sun(mjvScene& scene) {
  for (int i = 0; i < scene.nlight; ++i) {
    mjvLight& light = scene.lights[i];
    if (!light.headlight && light.type == mjLIGHT_DIRECTIONAL) return &light;
  }
  return nullptr;
}

/// Side planes of the view frustum through the eye, as unit normals that point inward.
std::array<Eigen::Vector3d, 4> sides_of(const View& view, double aspect) {
  const double half_height = 0.5 * view.field_of_view_rad;
  const double half_width = std::atan(std::tan(half_height) * aspect);
  const Eigen::Vector3d right = view.forward.cross(view.up);
  const auto side = [&](const Eigen::Vector3d& across, double half_angle) -> Eigen::Vector3d {
    return std::sin(half_angle) * view.forward + std::cos(half_angle) * across;
  };
  return {side(right, half_width), side(-right, half_width), side(view.up, half_height), side(-view.up, half_height)};
}

/// Smooth step: 0 for `x` <= from, 1 for `x` >= to.
double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Darkness of a lamp's shadows at the focus, 0 ... 1. Fades to 0 at the end of the lamp's shadow map (`reach_rad` off
/// its axis), where MuJoCo 3.17 draws speckles. Also fades to 0 where another lamp is equally near, because that lamp
/// then becomes the shadow light.
double shadow_weight(const mjvLight& lamp, const Eigen::Vector3d& focus, double reach_rad, double second_nearest_m) {
  constexpr double kEdge_rad = 0.09, kFade_rad = 0.22, kFade_m = 2.0;
  const Eigen::Vector3d ray = focus - to_eigen(lamp.pos);
  const double off_axis_rad = std::acos(std::clamp(ray.normalized().dot(to_eigen(lamp.dir).normalized()), -1.0, 1.0));
  return smooth_step(kEdge_rad, kEdge_rad + kFade_rad, reach_rad - off_axis_rad) *
         smooth_step(0.0, kFade_m, second_nearest_m - ray.norm());
}

void scale_light(mjvLight& light, double weight) {
  for (float* color : {light.ambient, light.diffuse, light.specular}) {
    for (int i = 0; i < 3; ++i) color[i] *= static_cast<float>(weight);
  }
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

SceneRenderer::SceneRenderer(const mjModel& view, int width, int height, double extinction_per_m, Renderer renderer)
    : model_(view),
      data_(sim::make_data(view)),
      offscreen_(view, width, height, renderer),
      dust_{extinction_per_m, to_color(view.vis.rgba.fog)},
      shadow_half_width_m_(static_cast<double>(view.vis.map.shadowclip) * view.stat.extent) {
  mjv_defaultOption(&options_);
  std::fill(std::begin(options_.geomgroup), std::end(options_.geomgroup), mjtByte{0});
  for (const int group : {sim::kGroupSolid, sim::kGroupVisualOnly, sim::kGroupRobotVisual})
    options_.geomgroup[group] = 1;
  std::fill(std::begin(options_.sitegroup), std::end(options_.sitegroup), mjtByte{0});
  mjv_defaultScene(&scene_);
  mjv_makeScene(&view, &scene_, 2 * static_cast<int>(view.ngeom) + 100);  // space for robot and ghost
  scene_.flags[mjRND_REFLECTION] = 0;
  scene_.flags[mjRND_HAZE] = 0;
  scene_.flags[mjRND_FOG] = 1;
  mj_forward(&model_, data_.get());
}

SceneRenderer::~SceneRenderer() { mjv_freeScene(&scene_); }

void SceneRenderer::set_state(const SimState& state) {
  put_state(model_, state, *data_);
  mj_comPos(&model_, data_.get());
  mj_camlight(&model_, data_.get());
}

void SceneRenderer::draw(const View& view, Frame& frame, std::vector<float>& depth) {
  scene_.camera[0] = scene_.camera[1] = gl_camera(view);
  mjv_updateScene(&model_, data_.get(), &options_, nullptr, nullptr, mjCAT_ALL, &scene_);
  add_ghost(scene_, model_, *data_, T_true_estimate_);
  center_light(view);
  cull_geoms(view);
  offscreen_.render(scene_);
  offscreen_.read(frame);
  offscreen_.read_depth(depth);
  add_haze(frame, depth, view, dust_);
}

// The shadow map covers a square around the sun's position: move the sun to the focus. Toward the sun the outer quarter
// of the square has speckles (depth offset too small in MuJoCo 3.17), so the square is shifted toward the sun.
void SceneRenderer::center_light(const View& view) {
  constexpr double kSunDistance_m = 25.0, kTowardsSun = 0.15;
  mjvLight* sun = find_sun(scene_);
  if (sun == nullptr) return select_shadow_light(view);
  const Eigen::Vector3d rays = to_eigen(sun->dir);
  const Eigen::Vector3d on_ground(rays.x(), rays.y(), 0.0);
  const Eigen::Vector3d p_light =
      view.focus - kSunDistance_m * rays - kTowardsSun * shadow_half_width_m_ * on_ground.normalized();
  for (int axis = 0; axis < 3; ++axis) sun->pos[axis] = static_cast<float>(p_light[axis]);
}

// Underground, shadows come from lamps. A frame has time for one shadow map: that of the nearest lamp. For partly dark
// shadows (`shadow_weight`) the lamp is split into two, one with and one without shadows.
void SceneRenderer::select_shadow_light(const View& view) {
  constexpr int kMaxLights = 8;  // limit of OpenGL's fixed-function pipeline
  const auto away_m = [&](const mjvLight& light) {
    return light.headlight ? std::numeric_limits<double>::infinity() : (to_eigen(light.pos) - view.focus).norm();
  };
  mjvLight* const end = scene_.lights + scene_.nlight;
  mjvLight* const lamp = std::ranges::min_element(scene_.lights, end, {}, away_m);
  has_shadow_lamp_ = false;
  if (lamp == end || lamp->headlight) return;
  double second_m = std::numeric_limits<double>::infinity();
  for (const mjvLight* other = scene_.lights; other != end; ++other) {
    if (other != lamp) second_m = std::min(second_m, away_m(*other));
  }
  const auto reach_deg = static_cast<double>(lamp->cutoff * model_.vis.map.shadowscale);
  double weight = shadow_weight(*lamp, view.focus, to_rad(reach_deg), second_m);
  const bool has_room = scene_.nlight < kMaxLights;
  if (!has_room) weight = std::round(weight);
  if (weight == 0.0) return;
  has_shadow_lamp_ = true;
  if (weight < 1.0) {
    mjvLight& rest = scene_.lights[scene_.nlight++];
    rest = *lamp;
    scale_light(rest, 1.0 - weight);
    scale_light(*lamp, weight);
  }
  lamp->castshadow = 1;
}

/// True if an object there could cast a shadow near the focus.
bool SceneRenderer::may_cast_shadow(const View& view, const Eigen::Vector3d& center, double radius) {
  constexpr double kLampShadow_m = 5.0;  // shadows of objects farther from the focus are not visible in the picture
  if (has_shadow_lamp_) return (center - view.focus).norm() < kLampShadow_m + radius;
  const mjvLight* sun = find_sun(scene_);
  if (sun == nullptr || scene_.flags[mjRND_SHADOW] == 0) return false;
  const double off_axis = (center - view.focus).cross(to_eigen(sun->dir).normalized()).norm();
  return off_axis < std::numbers::sqrt2 * shadow_half_width_m_ + radius;
}

// Removes geoms smaller than a pixel, and geoms that neither are in view nor cast a shadow into it. Vertex processing
// takes half of a frame in software.
void SceneRenderer::cull_geoms(const View& view) {
  const auto sides = sides_of(view, static_cast<double>(offscreen_.width()) / offscreen_.height());
  const auto is_in_view = [&](const Eigen::Vector3d& center, double radius) {
    return std::ranges::all_of(sides, [&](const Eigen::Vector3d& n) { return n.dot(center - view.eye) > -radius; });
  };
  constexpr double kTooSmall_px = 1.2;  // bounding radius
  const double focal_px = 0.5 * offscreen_.height() / std::tan(0.5 * view.field_of_view_rad);
  const auto is_speck = [&](const Eigen::Vector3d& center, double radius) {
    return focal_px * radius < kTooSmall_px * (center - view.eye).norm();
  };
  mjvGeom* const last = std::remove_if(scene_.geoms, scene_.geoms + scene_.ngeom, [&](const mjvGeom& geom) {
    if (geom.type == mjGEOM_PLANE || geom.type == mjGEOM_HFIELD || geom.modelrbound <= 0.0f) return false;
    const Eigen::Vector3d center = to_eigen(geom.pos);
    if (is_speck(center, geom.modelrbound)) return true;
    return !is_in_view(center, geom.modelrbound) && !may_cast_shadow(view, center, geom.modelrbound);
  });
  scene_.ngeom = static_cast<int>(last - scene_.geoms);
}

}  // namespace patrol::render
