#pragma once

#include <vector>

#include "core/frames.h"
#include "core/ground_truth.h"
#include "render/scene/camera.h"
#include "render/scene/frame.h"
#include "render/scene/haze.h"
#include "render/scene/offscreen.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// Sets the render quality of a replay. Vertex processing is half of the time of a software-rendered frame: round
/// shapes have a reduced number of sides, flat ones are not subdivided. Shadows cover 12.5 m around the focus, at 12 mm
/// per texel.
void set_replay_quality(mjModel& view);

/// Renders the world with robot and actors at a state of the simulation.
class SceneRenderer {
 public:
  /// `view` is a render model (sim/model_assembly.h) and must outlive the painter. `extinction_per_m` is that of the
  /// dust, drawn in the color of the world's fog. Throws std::runtime_error without OpenGL.
  SceneRenderer(const mjModel& view, int width, int height, double extinction_per_m = 0.0,
                Renderer renderer = software_renderer());
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  /// Moves robot and actors. Throws InputError when the state does not belong to this model.
  void set_state(const SimState& state);
  /// Sets the estimated pose of the body in the true one, at which the ghost is drawn (render/scene/ghost.h).
  void set_estimate(const Pose2& T_true_estimate) { T_true_estimate_ = T_true_estimate; }
  /// Renders a frame and reads it back. `depth` as in Offscreen::read_depth.
  void draw(const View& view, Frame& frame, std::vector<float>& depth);

  const mjData& data() const { return *data_; }
  Offscreen& offscreen() { return offscreen_; }
  /// Scene of the last frame.
  mjvScene& scene() { return scene_; }

 private:
  void center_light(const View& view);
  void select_shadow_light(const View& view);
  bool may_cast_shadow(const View& view, const Eigen::Vector3d& center, double radius);
  void cull_geoms(const View& view);

  const mjModel& model_;
  sim::DataPtr data_;
  Offscreen offscreen_;
  mjvScene scene_{};
  mjvOption options_{};
  Haze dust_;
  Pose2 T_true_estimate_;
  bool has_shadow_lamp_ = false;  ///< a lamp casts shadows in the last scene
  double shadow_half_width_m_;    ///< half of the side of the square that the shadow map covers
};

}  // namespace patrol::render
