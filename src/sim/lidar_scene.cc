#include "sim/lidar_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include "core/frames.h"
#include "sim/embree_scene.h"
#include "sim/mujoco.h"
#include "sim/robot_model.h"

namespace patrol::sim {
namespace {

bool is_visible_to_lidar(const mjModel& model, int geom) {
  const int group = model.geom_group[geom];
  const bool is_transparent = model.geom_rgba[4 * geom + 3] <= 0.0f;
  return group == kGroupLidarOnly || ((group == kGroupSolid || group == kGroupRobotVisual) && !is_transparent);
}

std::uint32_t mask_of(const mjModel& model, int body) {
  const int robot = mj_name2id(&model, mjOBJ_BODY, frame_id::kBody);
  if (robot < 0 || model.body_rootid[body] != model.body_rootid[robot]) return kRayScenery;
  const std::string_view name = name_of(model, mjOBJ_BODY, body);
  if (name == "lidar") return kRayLidar2d;
  if (name == "lidar3d") return kRayLidar3d;
  if (name == "lidar_rear") return kRayLidarRear;
  return name == "scanner" ? kRayScanner : kRayRobot;
}

/// Returns whether the ray enters the box before `reach_m` or starts inside it.
bool intersects(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                double reach_m) {
  const Eigen::Array3d inverse = direction.array().inverse();
  const Eigen::Array3d to_lower = (box.min() - origin).array() * inverse,
                       to_upper = (box.max() - origin).array() * inverse;
  const double enter = to_lower.min(to_upper).maxCoeff(), leave = to_lower.max(to_upper).minCoeff();
  return !(enter > leave || leave < 0.0 || enter > reach_m);
}

/// Axis-aligned bounding boxes, stored so that the compiler can test four at a time.
class Boxes {
 public:
  void resize(std::size_t count) {
    for (auto* side : {&lower_, &upper_}) {
      for (std::vector<float>& axis : *side) axis.resize(count);
    }
  }

  void add(const Eigen::AlignedBox3d& box) {
    resize(lower_[0].size() + 1);
    set(lower_[0].size() - 1, box.center(), box.sizes() / 2.0);
  }

  void set(std::size_t i, const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
    constexpr double kFloatLoss_m = 1e-3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      lower_[axis][i] = static_cast<float>(center[row] - half[row] - kFloatLoss_m);
      upper_[axis][i] = static_cast<float>(center[row] + half[row] + kFloatLoss_m);
    }
  }

  /// Calls `visit` with the index of every box that the ray may enter before `reach_m` or starts inside.
  template <typename Visit>
  void visit_intersected(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach_m,
                         Visit visit) const {
    // Replace zero components by a tiny value, so that the inverse is finite and no product below is 0 x infinity.
    const Eigen::Array3f inverse = (direction.array().abs() < 1e-12f).select(1e-12f, direction.array()).inverse();
    constexpr std::size_t kChunk = 64;
    // Length of the ray inside the box; negative if it misses.
    std::array<float, kChunk> stay;  // NOLINT(cppcoreguidelines-pro-type-member-init): per ray, filled below
    for (std::size_t begin = 0; begin < lower_[0].size(); begin += kChunk) {
      const std::size_t count = std::min(kChunk, lower_[0].size() - begin);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = begin + k;
        const float x0 = (lower_[0][i] - origin.x()) * inverse.x(), x1 = (upper_[0][i] - origin.x()) * inverse.x();
        const float y0 = (lower_[1][i] - origin.y()) * inverse.y(), y1 = (upper_[1][i] - origin.y()) * inverse.y();
        const float z0 = (lower_[2][i] - origin.z()) * inverse.z(), z1 = (upper_[2][i] - origin.z()) * inverse.z();
        const float enter = std::max(std::max(std::min(x0, x1), std::min(y0, y1)), std::max(std::min(z0, z1), 0.0f));
        const float leave = std::min(std::min(std::max(x0, x1), std::max(y0, y1)), std::min(std::max(z0, z1), reach_m));
        stay[k] = leave - enter;
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (stay[k] >= 0.0f) visit(begin + k);
      }
    }
  }

 private:
  std::array<std::vector<float>, 3> lower_, upper_;  ///< bounds, [axis][part]
};

/// Rigid group of geoms: a body and everything welded to it.
struct MovingPart {
  int body;
  std::uint32_t mask;
  std::vector<PlacedGeom> shapes = {};            ///< geoms that are not assets, with poses in the body's frame
  Boxes shape_boxes = {};                         ///< bounding boxes, [shape], in the body's frame
  std::unique_ptr<EmbreeScene> assets = nullptr;  ///< meshes and height fields; null if there are none
  Eigen::AlignedBox3d box = {};                   ///< bounding box of all geoms, in the body's frame
};

/// One instruction set for every processor: with another one hits differ in the last bits, and runs after minutes.
constexpr const char* kEmbreeConfiguration = "threads=1,isa=avx2";

/// Pose of a body in world.
struct BodyPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Matrix3 rotation = Matrix3::Zero();  ///< not yet set
};

}  // namespace

struct LidarScene::Poses {
  std::vector<BodyPose> parts;  ///< [part]
  Boxes boxes;                  ///< bounding boxes in world, [part]
};

struct LidarScene::Impl {
  explicit Impl(const mjModel& view) : model(view), device(rtcNewDevice(kEmbreeConfiguration)) {
    if (device == nullptr) throw std::runtime_error("Embree: device creation failed");
    static_scene = std::make_unique<EmbreeScene>(device, RTC_BUILD_QUALITY_HIGH);
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&model), mj_deleteData);
    mj_kinematics(&model, data.get());
    for (int geom = 0; geom < model.ngeom; ++geom) {
      if (is_visible_to_lidar(model, geom)) add_geom(*data, geom);
    }
    static_scene->build();
    for (MovingPart& part : parts) {
      if (part.assets) part.assets->build();
    }
    poses = std::make_shared<Poses>();
    poses->parts.resize(parts.size());
    poses->boxes.resize(parts.size());
    update_poses(*data);
  }

  ~Impl() {
    static_scene.reset();
    parts.clear();
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void add_geom(const mjData& data, int geom) {
    const int type = model.geom_type[geom];
    const int body = model.body_weldid[model.geom_bodyid[geom]];
    PlacedGeom placed{.geom = geom, .type = type, .position = {}, .rotation = {}, .size = {}};
    std::copy_n(model.geom_size + 3 * geom, 3, placed.size);
    const Eigen::Map<const Matrix3> R_world_body(data.xmat + 9 * body), R_world_geom(data.geom_xmat + 9 * geom);
    const Eigen::Map<const Eigen::Vector3d> p_body(data.xpos + 3 * body), p_geom(data.geom_xpos + 3 * geom);
    Eigen::Map<Eigen::Vector3d>(placed.position) = R_world_body.transpose() * (p_geom - p_body);
    Eigen::Map<Matrix3>(placed.rotation) = R_world_body.transpose() * R_world_geom;
    if (body == 0) {
      static_scene->add(model, placed);
      return;
    }
    MovingPart& part = part_of(body, mask_of(model, model.geom_bodyid[geom]));
    const Eigen::AlignedBox3d box = box_of(placed);
    part.box.extend(box);
    if (!is_asset(type)) {
      part.shapes.push_back(placed);
      part.shape_boxes.add(box);
      return;
    }
    if (!part.assets) part.assets = std::make_unique<EmbreeScene>(device, RTC_BUILD_QUALITY_MEDIUM);
    part.assets->add(model, placed);
  }

  MovingPart& part_of(int body, std::uint32_t mask) {
    for (MovingPart& part : parts) {
      if (part.body == body && part.mask == mask) return part;
    }
    return parts.emplace_back(MovingPart{.body = body, .mask = mask});
  }

  /// Returns the bounding box of a geom, along the axes of the frame in which it is placed.
  Eigen::AlignedBox3d box_of(const PlacedGeom& placed) const {
    const Eigen::Map<const Eigen::Vector3d> position(placed.position), middle(model.geom_aabb + 6 * placed.geom);
    const Eigen::Map<const Matrix3> rotation(placed.rotation);
    const Eigen::Vector3d half =
        rotation.cwiseAbs() * Eigen::Map<const Eigen::Vector3d>(model.geom_aabb + 6 * placed.geom + 3);
    const Eigen::Vector3d center = position + rotation * middle;
    return {center - half, center + half};
  }

  void update_poses(const mjData& data) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const MovingPart& part = parts[i];
      const Eigen::Map<const Eigen::Vector3d> position(data.xpos + 3 * part.body);
      const Eigen::Map<const Matrix3> rotation(data.xmat + 9 * part.body);
      if (poses->parts[i].position == position && poses->parts[i].rotation == rotation) continue;
      if (std::exchange(are_given_out, false)) poses = std::make_shared<Poses>(*poses);
      BodyPose& pose = poses->parts[i];
      pose = {position, rotation};
      poses->boxes.set(i, pose.position + pose.rotation * part.box.center(),
                       pose.rotation.cwiseAbs() * part.box.sizes() / 2.0);
    }
  }

  /// Replaces `best` by the hit on a part if it is nearer than `reach_m`, and reduces `reach_m`.
  static void cast_at_part(const MovingPart& part, const BodyPose& pose, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction, double& reach_m, std::optional<RayHit>& best) {
    const Eigen::Vector3d from = pose.rotation.transpose() * (origin - pose.position);
    const Eigen::Vector3d along = pose.rotation.transpose() * direction;
    if (!intersects(part.box, from, along, reach_m)) return;
    bool is_nearer = false;
    if (part.assets) {
      if (const auto hit = part.assets->cast(from, along, reach_m)) {
        best = hit;
        reach_m = hit->distance_m;
        is_nearer = true;
      }
    }
    const auto cast_at_shape = [&](std::size_t i) {
      const PlacedGeom& shape = part.shapes[i];
      Eigen::Vector3d normal;
      const double distance_m =
          mju_rayGeom(shape.position, shape.rotation, shape.size, from.data(), along.data(), shape.type, normal.data());
      if (distance_m < 0.0 || distance_m >= reach_m) return;
      best = RayHit{.distance_m = distance_m, .geom = shape.geom, .normal = normal};
      reach_m = distance_m;
      is_nearer = true;
    };
    part.shape_boxes.visit_intersected(from.cast<float>(), along.cast<float>(), static_cast<float>(reach_m),
                                       cast_at_shape);
    if (is_nearer) best->normal = pose.rotation * best->normal;
  }

  std::optional<RayHit> cast(const Poses& at, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m, std::uint32_t mask) const {
    std::optional<RayHit> best;
    if (mask & kRayScenery) best = static_scene->cast(origin, direction, max_range_m);
    double reach_m = best ? best->distance_m : max_range_m;
    const auto cast_at = [&](std::size_t i) {
      if (parts[i].mask & mask) cast_at_part(parts[i], at.parts[i], origin, direction, reach_m, best);
    };
    at.boxes.visit_intersected(origin.cast<float>(), direction.cast<float>(), static_cast<float>(reach_m), cast_at);
    if (best && best->normal.dot(direction) > 0.0) best->normal = -best->normal;
    return best;
  }

  const mjModel& model;
  RTCDevice device;
  std::unique_ptr<EmbreeScene> static_scene;
  std::vector<MovingPart> parts;
  std::shared_ptr<Poses> poses;  ///< present poses
  bool are_given_out = false;    ///< others may read `poses` in another thread: they are copied before a change
};

LidarScene::LidarScene(const mjModel& view) : impl_(std::make_unique<Impl>(view)) {}
LidarScene::~LidarScene() = default;

const mjModel& LidarScene::model() const { return impl_->model; }
RTCSceneTy* LidarScene::static_scene() const { return impl_->static_scene->handle(); }
void LidarScene::update(const mjData& data) { impl_->update_poses(data); }

std::optional<RayHit> LidarScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                       double max_range_m, std::uint32_t mask) const {
  return impl_->cast(*impl_->poses, origin, direction, max_range_m, mask);
}

std::shared_ptr<const LidarScene::Poses> LidarScene::poses() const {
  impl_->are_given_out = true;
  return impl_->poses;
}

std::optional<RayHit> LidarScene::cast(const Poses& poses, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction, double max_range_m, std::uint32_t mask) const {
  return impl_->cast(poses, origin, direction, max_range_m, mask);
}

}  // namespace patrol::sim
