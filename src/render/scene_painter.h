#pragma once

#include <vector>

#include "core/frames.h"
#include "core/ground_truth.h"
#include "render/camera.h"
#include "render/frame.h"
#include "render/haze.h"
#include "render/offscreen.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// Sets what a replay can afford. Vertex work is half of a software-rendered frame: round shapes get as many
/// sides as the eye asks for, flat ones are not divided. Shadows reach as far as one looks for them, at 12 mm
/// a texel.
void set_replay_quality(mjModel& view);

/// Draws the world and everything in it, as a state of the simulation has it.
class ScenePainter {
 public:
  /// `view` is a model for renders (sim/model_assembly.h) and must outlive the painter. Dust that stops a share of light
  /// per metre has the colour of the world's fog. Throws std::runtime_error without OpenGL.
  ScenePainter(const mjModel& view, int width, int height, double extinction_per_m = 0.0, Renderer renderer = software_renderer());
  ~ScenePainter();
  ScenePainter(const ScenePainter&) = delete;
  ScenePainter& operator=(const ScenePainter&) = delete;

  /// Moves robot and actors. Throws InputError when the state is not one of this model.
  void set_state(const SimState& state);
  /// Where the robot believes to be, seen from where it is: there stands a ghost (render/ghost.h). Not before the first call.
  void set_estimate(const Pose2& T_true_estimate) { T_true_estimate_ = T_true_estimate; }
  /// Draws and reads back; `depth` as in Offscreen::read_depth.
  void draw(const View& view, Frame& frame, std::vector<float>& depth);

  const mjData& data() const { return *data_; }
  Offscreen& offscreen() { return offscreen_; }
  /// As last drawn.
  mjvScene& scene() { return scene_; }

 private:
  void light_around(const View& view);
  void let_nearest_lamp_throw_shadows(const View& view);
  bool may_shade(const View& view, const Eigen::Vector3d& center, double radius);
  void drop_unseen(const View& view);

  const mjModel& model_;
  sim::DataPtr data_;
  Offscreen offscreen_;
  mjvScene scene_;
  mjvOption options_;
  Haze dust_;
  Pose2 T_true_estimate_;
  bool has_shadow_lamp_ = false;  ///< in the last scene
  double shadow_reach_m_;  ///< half the side of the square that the shadow map covers
};

}  // namespace patrol::render
