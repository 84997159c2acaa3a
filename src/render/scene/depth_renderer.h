#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "render/scene/frame.h"
#include "render/scene/offscreen.h"
#include "sim/mujoco.h"
#include "sim/sensors/depth_camera.h"

namespace patrol::render {

/// Ideal image of a depth camera, from the depth buffer of an off-screen render. Draws the visible geoms: groups 0 and
/// 1 and the robot's visual geoms, without the camera housing (link `depth_camera`) and without geoms of low opacity.
/// There are no lights, textures or shadows; each geom has one color that encodes its reflectivity. The cost of
/// software rendering grows with the number of vertices: only geoms in the field of view are drawn, and of large meshes
/// only the faces near the camera.
///
/// Approximations: Round shapes have 40 sides, an error of at most 0.3 % of their radius. Bars up to 6 cm thick have a
/// square section, an error of at most 8 mm. The reflectivity of a textured geom is that of its color without the
/// texture.
class DepthRenderer : public sim::DepthImager {
 public:
  /// Parameters as in sim::DepthImagerFactory. Throws std::runtime_error without OpenGL. May be used only in the thread
  /// that created it.
  DepthRenderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m);
  ~DepthRenderer() override;
  DepthRenderer(const DepthRenderer&) = delete;
  DepthRenderer& operator=(const DepthRenderer&) = delete;

  /// Renders depth and reflectivity, row 0 at the top. Depth is along the viewing axis, infinite without a surface.
  void draw(const sim::BodyPoses& bodies, const Pose3& T_world_camera, sim::IdealDepthImage& image) override;

  /// Number of geoms in the last picture.
  int num_drawn() const { return scene_.ngeom; }
  /// Number of uploaded triangles of large meshes.
  int num_near_faces() const;

 private:
  /// Drawable geom with its pose relative to its body.
  struct Shape {
    int geom;
    int body;                         ///< body id; 0: world
    Eigen::Vector3d position;         ///< in the body frame
    Eigen::Matrix3d rotation;         ///< R_body_geom
    double radius_m;                  ///< radius of the bounding sphere about `position`; 0 for a plane
    std::array<bool, 2> is_infinite;  ///< plane without end along its x, y
    mjvGeom drawn;
  };
  struct Camera;
  /// Static mesh of which only the faces near the camera are uploaded.
  struct LargeMesh {
    int mesh;
    std::vector<Eigen::Vector3d> face_middles;  ///< centroids in world
    std::vector<double> face_radii_m;
    std::vector<std::array<int, 9>> face_indices;  ///< indices of vertices, normals and texture coordinates
  };

  void collect();
  void find_large_meshes();
  void upload_near(const Eigen::Vector3d& eye);
  static void update_pose(Shape& shape, const sim::BodyPoses& bodies);
  void limit_infinite_plane(Shape& shape, const Camera& camera) const;
  bool is_in_view(const Shape& shape, const Camera& camera) const;
  void aim(const Camera& camera);

  sim::PinholeLens lens_;
  double near_m_, far_m_;
  /// copy of the render model without textures and shadows; its large meshes contain only the faces near the camera
  sim::ModelPtr model_;
  Offscreen offscreen_;
  mjvScene scene_{};
  std::vector<Shape> shapes_;
  std::vector<LargeMesh> large_meshes_;
  std::optional<Eigen::Vector3d> uploaded_about_;
  Frame colors_;
  std::vector<float> depth_;
};

/// Implements sim::DepthImagerFactory.
std::unique_ptr<sim::DepthImager> make_depth_renderer(const mjModel& view, const sim::PinholeLens& lens, double near_m,
                                                      double far_m);

}  // namespace patrol::render
