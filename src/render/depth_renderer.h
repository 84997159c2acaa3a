#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "render/frame.h"
#include "render/offscreen.h"
#include "sim/mujoco.h"
#include "sim/sensors/depth_camera.h"

namespace patrol::render {

/// The depth camera's perfect picture, from the depth buffer of an off-screen render. Drawn is what an eye would see, groups 0
/// and 1 and the robot's own shapes, but for the housing (the link `depth_camera`) and what is mostly transparent; with no
/// light, texture or shadow, each shape in one colour that says how much light it throws back. Only what may be in sight is
/// drawn: software rendering costs by vertices.
///
/// Round shapes have 40 sides: off by 0.3 % of their radius at most. How much light a textured shape throws back is taken from its
/// colour without the texture.
class DepthRenderer : public sim::DepthImager {
 public:
  /// As sim::DepthImagerFactory. Throws std::runtime_error without OpenGL. It belongs to the thread that made it.
  DepthRenderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m);
  ~DepthRenderer() override;
  DepthRenderer(const DepthRenderer&) = delete;
  DepthRenderer& operator=(const DepthRenderer&) = delete;

  void draw(const mjData& data, const Pose3& T_world_camera, sim::SurfaceImage& image) override;

  /// In the last picture.
  int num_drawn() const { return scene_.ngeom; }

 private:
  /// A shape that may be drawn, and where it is fixed.
  struct Shape {
    int geom;
    int body;                  ///< 0: the world
    Eigen::Vector3d position;  ///< in the body
    Eigen::Matrix3d rotation;  ///< body from geom
    double radius_m;           ///< about `position`; 0: a plane
    std::array<bool, 2> is_endless;  ///< of a plane: along its x, y
    mjvGeom drawn;
  };
  struct Camera;

  void collect(const mjModel& view);
  void place(Shape& shape, const mjData& data) const;
  void cut_endless(Shape& shape, const Camera& camera) const;
  bool is_in_sight(const Shape& shape, const Camera& camera) const;
  void aim(const Camera& camera);

  sim::PinholeLens lens_;
  double near_m_, far_m_;
  Offscreen offscreen_;
  mjvScene scene_;
  std::vector<Shape> shapes_;
  Frame colors_;
  std::vector<float> depth_;
};

/// For the twin.
std::unique_ptr<sim::DepthImager> make_depth_renderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m);

}  // namespace patrol::render
