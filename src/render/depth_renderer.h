#pragma once

#include <array>
#include <memory>
#include <optional>
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
/// drawn, and of large meshes only what is near: software rendering costs by vertices.
///
/// Round shapes have 40 sides: off by 0.3 % of their radius at most; bars up to 6 cm thick are drawn square, within 8 mm. How much light a textured shape throws back is taken from its
/// colour without the texture.
class DepthRenderer : public sim::DepthImager {
 public:
  /// As sim::DepthImagerFactory. Throws std::runtime_error without OpenGL. It belongs to the thread that made it.
  DepthRenderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m);
  ~DepthRenderer() override;
  DepthRenderer(const DepthRenderer&) = delete;
  DepthRenderer& operator=(const DepthRenderer&) = delete;

  void draw(const mjData& data, const Pose3& T_world_camera, sim::SurfaceImage& image) override;

  /// Shapes in the last picture.
  int num_drawn() const { return scene_.ngeom; }
  /// Triangles of large meshes that are ready to be drawn.
  int num_near_faces() const;

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
  /// A mesh of the world of which only what is near the camera is uploaded.
  struct LargeMesh {
    int mesh;
    std::vector<Eigen::Vector3d> face_middles;     ///< in world
    std::vector<double> face_radii_m;
    std::vector<std::array<int, 9>> face_indices;  ///< of its vertices, normals, texture coordinates
  };

  void collect();
  void find_large_meshes();
  void upload_near(const Eigen::Vector3d& eye);
  void place(Shape& shape, const mjData& data) const;
  void cut_endless(Shape& shape, const Camera& camera) const;
  bool is_in_sight(const Shape& shape, const Camera& camera) const;
  void aim(const Camera& camera);

  sim::PinholeLens lens_;
  double near_m_, far_m_;
  sim::ModelPtr model_;  ///< the view without looks; its large meshes are cut to what is near
  Offscreen offscreen_;
  mjvScene scene_;
  std::vector<Shape> shapes_;
  std::vector<LargeMesh> large_meshes_;
  std::optional<Eigen::Vector3d> uploaded_about_;
  Frame colors_;
  std::vector<float> depth_;
};

/// For the twin.
std::unique_ptr<sim::DepthImager> make_depth_renderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m);

}  // namespace patrol::render
