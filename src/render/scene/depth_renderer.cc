#include "render/scene/depth_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "sim/robot_model.h"

namespace patrol::render {
namespace {

using RowMajor3 = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;

constexpr float kBrightest = 254.0f;  // the red channel contains the segment number plus one

/// Copies the render model for OpenGL without textures, shadows and multisampling.
sim::ModelPtr strip_appearance(const mjModel& view, const sim::PinholeLens& lens) {
  sim::ModelPtr model(mj_copyModel(nullptr, &view));
  model->ntex = 0;
  model->vis.quality.shadowsize = 0;
  model->vis.quality.offsamples = 0;
  model->vis.quality.numslices = 40;
  model->vis.quality.numstacks = 24;
  model->vis.quality.numquads = 1;
  model->vis.global.offwidth = lens.width_px;
  model->vis.global.offheight = lens.height_px;
  return model;
}

const float* rgba_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  return material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
}

bool is_housing(const mjModel& model, int geom) {
  return sim::name_of(model, mjOBJ_BODY, model.geom_bodyid[geom]) == "depth_camera";
}

bool is_drawn(const mjModel& model, int geom) {
  constexpr float kSeeThrough = 0.5f;
  const int group = model.geom_group[geom];
  const bool is_visible_group =
      group == sim::kGroupSolid || group == sim::kGroupVisualOnly || group == sim::kGroupRobotVisual;
  const float alpha = std::min(model.geom_rgba[4 * geom + 3], rgba_of(model, geom)[3]);
  return is_visible_group && alpha > kSeeThrough && !is_housing(model, geom);
}

/// Luminance of the geom's color (ITU-R BT.709).
float reflectivity_of(const mjModel& model, int geom) {
  const float* rgba = rgba_of(model, geom);
  return std::clamp(0.2126f * rgba[0] + 0.7152f * rgba[1] + 0.0722f * rgba[2], 0.0f, 1.0f);
}

/// Replaces a thin round bar by a square bar of equal cross-section with a hundredth of the vertices. The error is a
/// quarter of the radius at the edges, at most 8 mm.
void use_square_section(mjvGeom& drawn) {
  constexpr float kThin_m = 0.03f;
  if (drawn.type != mjGEOM_CAPSULE && drawn.type != mjGEOM_CYLINDER) return;
  const float radius_m = drawn.size[0];
  if (radius_m > kThin_m) return;
  const float half_side_m = 0.886f * radius_m;  // sqrt(pi) / 2
  const float half_length_m = drawn.size[2] + (drawn.type == mjGEOM_CAPSULE ? half_side_m : 0.0f);
  drawn.type = mjGEOM_BOX;
  drawn.size[0] = drawn.size[1] = half_side_m;
  drawn.size[2] = half_length_m;
}

}  // namespace

/// Camera pose, and the side planes of its field of view as unit normals that point inward.
struct DepthRenderer::Camera {
  Camera(const Pose3& T_world_camera, const sim::PinholeLens& lens)
      : eye(T_world_camera.position), R(T_world_camera.rotation.toRotationMatrix()) {
    const double half_width = 0.5 * lens.width_px / lens.focal_px, half_height = 0.5 * lens.height_px / lens.focal_px;
    sides = {Eigen::Vector3d(half_width, 1.0, 0.0), Eigen::Vector3d(half_width, -1.0, 0.0),
             Eigen::Vector3d(half_height, 0.0, 1.0), Eigen::Vector3d(half_height, 0.0, -1.0)};
    for (Eigen::Vector3d& side : sides) side = R * side.normalized();
  }
  Eigen::Vector3d forward() const { return R.col(0); }
  Eigen::Vector3d up() const { return R.col(2); }

  Eigen::Vector3d eye;
  Eigen::Matrix3d R;
  std::array<Eigen::Vector3d, 4> sides;
};

DepthRenderer::DepthRenderer(const mjModel& view, const sim::PinholeLens& lens, double near_m, double far_m)
    : lens_(lens),
      near_m_(near_m),
      far_m_(far_m),
      model_(strip_appearance(view, lens)),
      offscreen_(*model_, lens.width_px, lens.height_px) {
  offscreen_.context().readDepthMap = mjDEPTH_ZEROFAR;  // as stored by OpenGL, with the best resolution far away
  collect();
  find_large_meshes();
  mjv_defaultScene(&scene_);
  mjv_makeScene(nullptr, &scene_, static_cast<int>(shapes_.size()) + 1);
  std::fill(std::begin(scene_.flags), std::end(scene_.flags), mjtByte{0});
  scene_.flags[mjRND_SEGMENT] = scene_.flags[mjRND_IDCOLOR] = 1;
}

DepthRenderer::~DepthRenderer() { mjv_freeScene(&scene_); }

void DepthRenderer::collect() {
  const mjModel& view = *model_;
  constexpr float kWhite[4] = {1.0f, 1.0f, 1.0f, 1.0f};
  for (int geom = 0; geom < view.ngeom; ++geom) {
    if (!is_drawn(view, geom)) continue;
    const mjtNum* q = view.geom_quat + 4 * geom;
    Shape shape{.geom = geom,
                .body = view.geom_bodyid[geom],
                .position = Eigen::Vector3d(view.geom_pos + 3 * geom),
                .rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(),
                .radius_m = view.geom_rbound[geom],
                .is_infinite = {view.geom_size[3 * geom] <= 0.0, view.geom_size[3 * geom + 1] <= 0.0},
                .drawn = {}};
    const RowMajor3 R = shape.rotation;
    mjv_initGeom(&shape.drawn, view.geom_type[geom], view.geom_size + 3 * geom, shape.position.data(), R.data(),
                 kWhite);
    if (view.geom_type[geom] == mjGEOM_MESH) shape.drawn.dataid = 2 * view.geom_dataid[geom];
    if (view.geom_type[geom] == mjGEOM_HFIELD) shape.drawn.dataid = view.geom_dataid[geom];
    use_square_section(shape.drawn);
    shape.drawn.segid = static_cast<int>(std::lround(kBrightest * reflectivity_of(view, geom)));
    shapes_.push_back(shape);
  }
}

/// Finds the static meshes with many faces that are used by one geom only.
void DepthRenderer::find_large_meshes() {
  constexpr int kLarge = 1000;  // faces
  mjModel& model = *model_;
  for (const Shape& shape : shapes_) {
    const int mesh = model.geom_dataid[shape.geom];
    if (model.geom_type[shape.geom] != mjGEOM_MESH || shape.body != 0 || model.mesh_facenum[mesh] < kLarge) continue;
    const auto is_of_mesh = [&](const Shape& other) {
      return model.geom_type[other.geom] == mjGEOM_MESH && model.geom_dataid[other.geom] == mesh;
    };
    if (std::ranges::count_if(shapes_, is_of_mesh) > 1) continue;
    LargeMesh large{.mesh = mesh, .face_middles = {}, .face_radii_m = {}, .face_indices = {}};
    const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
    for (int i = 0, face = model.mesh_faceadr[mesh]; i < model.mesh_facenum[mesh]; ++i, ++face) {
      std::array<int, 9> indices{};
      std::copy_n(model.mesh_face + 3 * face, 3, indices.begin());
      std::copy_n(model.mesh_facenormal + 3 * face, 3, indices.begin() + 3);
      std::copy_n(model.mesh_facetexcoord + 3 * face, 3, indices.begin() + 6);
      Eigen::Matrix3d corners;
      for (int k = 0; k < 3; ++k)
        corners.col(k) =
            Eigen::Map<const Eigen::Vector3f>(vertices + 3 * indices[static_cast<std::size_t>(k)]).cast<double>();
      const Eigen::Vector3d middle = corners.rowwise().mean();
      large.face_middles.emplace_back(shape.position + shape.rotation * middle);
      large.face_radii_m.push_back((corners.colwise() - middle).colwise().norm().maxCoeff());
      large.face_indices.push_back(indices);
    }
    model.mesh_graphadr[mesh] = -1;  // the convex hull is not drawn
    large_meshes_.push_back(std::move(large));
  }
}

/// Uploads the faces of large meshes that the camera can observe until it has moved by `kStep_m`.
void DepthRenderer::upload_near(const Eigen::Vector3d& eye) {
  constexpr double kStep_m = 3.0;
  if (large_meshes_.empty() || (uploaded_about_ && (eye - *uploaded_about_).norm() < kStep_m)) return;
  uploaded_about_ = eye;
  // The corners of the picture are farther from the camera than the far plane.
  const double reach_m =
      kStep_m +
      far_m_ *
          Eigen::Vector3d(1.0, 0.5 * lens_.width_px / lens_.focal_px, 0.5 * lens_.height_px / lens_.focal_px).norm();
  mjModel& model = *model_;
  for (const LargeMesh& large : large_meshes_) {
    int face = model.mesh_faceadr[large.mesh];
    for (std::size_t i = 0; i < large.face_middles.size(); ++i) {
      if ((large.face_middles[i] - eye).norm() > reach_m + large.face_radii_m[i]) continue;
      const int* indices = large.face_indices[i].data();
      std::copy_n(indices, 3, model.mesh_face + 3 * face);
      std::copy_n(indices + 3, 3, model.mesh_facenormal + 3 * face);
      std::copy_n(indices + 6, 3, model.mesh_facetexcoord + 3 * face);
      ++face;
    }
    model.mesh_facenum[large.mesh] = face - model.mesh_faceadr[large.mesh];
    mjr_uploadMesh(&model, &offscreen_.context(), large.mesh);
  }
}

int DepthRenderer::num_near_faces() const {
  int count = 0;
  for (const LargeMesh& large : large_meshes_) count += model_->mesh_facenum[large.mesh];
  return count;
}

/// Sets the geom's pose from the pose of its body.
void DepthRenderer::update_pose(Shape& shape, const sim::BodyPoses& bodies) {
  if (shape.body == 0) return;
  const Eigen::Map<const RowMajor3> R_world_body = bodies.rotation(shape.body);
  const Eigen::Vector3d position = bodies.position(shape.body) + R_world_body * shape.position;
  const RowMajor3 R = R_world_body * shape.rotation;
  for (int i = 0; i < 3; ++i) shape.drawn.pos[i] = static_cast<float>(position[i]);
  for (int i = 0; i < 9; ++i) shape.drawn.mat[i] = static_cast<float>(R.data()[i]);
}

/// Limits an infinite plane to the camera's range, centered below the camera.
void DepthRenderer::limit_infinite_plane(Shape& shape, const Camera& camera) const {
  if (shape.drawn.type != mjGEOM_PLANE) return;
  Eigen::Map<Eigen::Vector3f> position(shape.drawn.pos);
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> R(shape.drawn.mat);
  const Eigen::Vector3f to_eye = camera.eye.cast<float>() - position;
  for (int axis = 0; axis < 2; ++axis) {
    if (!shape.is_infinite[static_cast<std::size_t>(axis)]) continue;
    shape.drawn.size[axis] = static_cast<float>(2.0 * far_m_);
    position += R.col(axis) * R.col(axis).dot(to_eye);
  }
}

bool DepthRenderer::is_in_view(const Shape& shape, const Camera& camera) const {
  if (shape.radius_m <= 0.0) return true;
  const Eigen::Vector3d to_shape = Eigen::Map<const Eigen::Vector3f>(shape.drawn.pos).cast<double>() - camera.eye;
  const double ahead_m = camera.forward().dot(to_shape);
  if (ahead_m < near_m_ - shape.radius_m || ahead_m > far_m_ + shape.radius_m) return false;
  return std::ranges::all_of(camera.sides,
                             [&](const Eigen::Vector3d& side) { return side.dot(to_shape) > -shape.radius_m; });
}

void DepthRenderer::aim(const Camera& camera) {
  mjvGLCamera gl{};
  for (int axis = 0; axis < 3; ++axis) {
    gl.pos[axis] = static_cast<float>(camera.eye[axis]);
    gl.forward[axis] = static_cast<float>(camera.forward()[axis]);
    gl.up[axis] = static_cast<float>(camera.up()[axis]);
  }
  gl.frustum_width = static_cast<float>(near_m_ * 0.5 * lens_.width_px / lens_.focal_px);  // half width
  gl.frustum_top = static_cast<float>(near_m_ * 0.5 * lens_.height_px / lens_.focal_px);
  gl.frustum_bottom = -gl.frustum_top;
  gl.frustum_near = static_cast<float>(near_m_);
  gl.frustum_far = static_cast<float>(far_m_);
  scene_.camera[0] = scene_.camera[1] = gl;
}

void DepthRenderer::draw(const sim::BodyPoses& bodies, const Pose3& T_world_camera, sim::IdealDepthImage& image) {
  const Camera camera(T_world_camera, lens_);
  offscreen_.make_current();
  upload_near(camera.eye);
  aim(camera);
  scene_.ngeom = 0;
  for (Shape& shape : shapes_) {
    update_pose(shape, bodies);
    limit_infinite_plane(shape, camera);
    if (is_in_view(shape, camera)) scene_.geoms[scene_.ngeom++] = shape.drawn;
  }
  offscreen_.render(scene_);
  offscreen_.read(colors_);
  offscreen_.read_depth(depth_);

  image.depth_m.resize(depth_.size());
  image.reflectivity.resize(depth_.size());
  for (std::size_t pixel = 0; pixel < depth_.size(); ++pixel) {
    // Depth value: 1 at the near plane, 0 at the far plane, linear in the inverse depth.
    const auto fraction = static_cast<double>(depth_[pixel]);
    const bool is_something = fraction > 0.0;
    image.depth_m[pixel] = is_something
                               ? static_cast<float>(near_m_ * far_m_ / (near_m_ + fraction * (far_m_ - near_m_)))
                               : std::numeric_limits<float>::infinity();
    const auto red = static_cast<float>(colors_.bytes()[3 * pixel]);
    image.reflectivity[pixel] = is_something ? std::max(0.0f, red - 1.0f) / kBrightest : 0.0f;
  }
}

std::unique_ptr<sim::DepthImager> make_depth_renderer(const mjModel& view, const sim::PinholeLens& lens, double near_m,
                                                      double far_m) {
  // Threads of the rasterizer of OSMesa cost more than they save on small images. The environment of the user prevails.
  ::setenv("LP_NUM_THREADS", "0", 0);
  return std::make_unique<DepthRenderer>(view, lens, near_m, far_m);
}

}  // namespace patrol::render
