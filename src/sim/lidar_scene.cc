#include "sim/lidar_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

constexpr double kBoxMargin_m = 1e-3;  ///< exceeds the rounding of coordinates to float

/// Axis-aligned bounding boxes, four side by side so that one instruction tests four.
class Boxes {
 public:
  void resize(std::size_t count) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    PackedBoxes unused;
    for (auto* side : {&unused.lower, &unused.upper}) side->fill(Pack::Constant(kInfinity));
    packs_.resize((count + kPack - 1) / kPack, unused);
    count_ = count;
  }

  void add(const Eigen::AlignedBox3d& box) {
    resize(count_ + 1);
    set(count_ - 1, box.center(), box.sizes() / 2.0);
  }

  void set(std::size_t i, const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
    const auto lane = static_cast<Eigen::Index>(i % kPack);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      packs_[i / kPack].lower[axis][lane] = static_cast<float>(center[row] - half[row] - kBoxMargin_m);
      packs_[i / kPack].upper[axis][lane] = static_cast<float>(center[row] + half[row] + kBoxMargin_m);
    }
  }

  /// Calls `visit` with the index of every box that the ray may enter before `reach_m` or starts inside.
  template <typename Visit>
  void visit_intersected(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach_m,
                         Visit visit) const {
    // Replace zero components by a tiny value, so that the inverse is finite and no product below is 0 x infinity.
    const Eigen::Array3f inverse = (direction.array().abs() < 1e-12f).select(1e-12f, direction.array()).inverse();
    for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
      Pack enter = Pack::Zero(), leave = Pack::Constant(reach_m);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        const Pack to_lower = (packs_[pack].lower[axis] - origin[row]) * inverse[row],
                   to_upper = (packs_[pack].upper[axis] - origin[row]) * inverse[row];
        enter = enter.max(to_lower.min(to_upper));
        leave = leave.min(to_lower.max(to_upper));
      }
      const Pack stay = leave - enter;  // length of the ray inside the box; negative if it misses
      if (stay.maxCoeff() < 0.0f) continue;
      for (std::size_t lane = 0; lane < kPack; ++lane) {
        if (stay[static_cast<Eigen::Index>(lane)] >= 0.0f) visit(kPack * pack + lane);
      }
    }
  }

 private:
  static constexpr std::size_t kPack = 4;
  using Pack = Eigen::Array<float, kPack, 1>;
  struct PackedBoxes {
    std::array<Pack, 3> lower, upper;  ///< [axis][part % 4]; unused: infinitely far
  };

  std::vector<PackedBoxes> packs_;  ///< [part / 4]
  std::size_t count_ = 0;
};

/// Rigid group of geoms: a body and everything welded to it.
struct MovingPart {
  int body;
  std::uint32_t mask;
  std::vector<PlacedGeom> shapes = {};               ///< geoms that are not assets, with poses in the body's frame
  Boxes shape_boxes = {};                            ///< bounding boxes, [shape], in the body's frame
  std::vector<Eigen::AlignedBox3d> wide_boxes = {};  ///< the same with a margin
  std::unique_ptr<EmbreeScene> assets = nullptr;     ///< meshes and height fields; null if there are none
  Eigen::AlignedBox3d box = {};                      ///< bounding box of all geoms, in the body's frame
};

/// One instruction set for every processor: with another one hits differ in the last bits, and runs after minutes.
constexpr const char* kEmbreeConfiguration = "threads=1,isa=avx2";

/// Pose of a body in world.
struct BodyPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Matrix3 rotation = Matrix3::Zero();  ///< rotation of the body; zero: not yet set
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
      part.wide_boxes.emplace_back(box.min().array() - kBoxMargin_m, box.max().array() + kBoxMargin_m);
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

  /// Replaces `best` by the hit on a part if it is nearer than `reach_m`, and reduces `reach_m`. `visit_shapes` calls
  /// its last argument with the index of every shape that the ray, in the body's frame, may hit within its reach.
  template <typename VisitShapes>
  static void cast_at_part(const MovingPart& part, const BodyPose& pose, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction, double& reach_m, std::optional<RayHit>& best,
                           VisitShapes visit_shapes) {
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
    visit_shapes(from, along, reach_m, [&](std::size_t i) {
      const PlacedGeom& shape = part.shapes[i];
      Eigen::Vector3d normal;
      const double distance_m =
          mju_rayGeom(shape.position, shape.rotation, shape.size, from.data(), along.data(), shape.type, normal.data());
      if (distance_m < 0.0 || distance_m >= reach_m) return;
      best = RayHit{.distance_m = distance_m, .geom = shape.geom, .normal = normal};
      reach_m = distance_m;
      is_nearer = true;
    });
    if (is_nearer) best->normal = pose.rotation * best->normal;
  }

  /// Returns the first hit, given that on the static scene. `cast_at_parts` replaces it by a nearer one on a part.
  template <typename CastAtParts>
  static std::optional<RayHit> with_parts(std::optional<RayHit> best, const Eigen::Vector3d& direction,
                                          double max_range_m, CastAtParts cast_at_parts) {
    double reach_m = best ? best->distance_m : max_range_m;
    cast_at_parts(reach_m, best);
    if (best && best->normal.dot(direction) > 0.0) best->normal = -best->normal;
    return best;
  }

  std::optional<RayHit> cast_at_static(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                       double max_range_m, std::uint32_t mask) const {
    return mask & kRayScenery ? static_scene->cast(origin, direction, max_range_m) : std::nullopt;
  }

  /// Returns the first hit, given that on the static scene.
  std::optional<RayHit> complete(const std::optional<RayHit>& hit, const Poses& at, const Ray& ray, double max_range_m,
                                 std::uint32_t mask) const {
    return with_parts(hit, ray.direction, max_range_m, [&](double& reach_m, std::optional<RayHit>& best) {
      const auto cast_at = [&](std::size_t i) {
        const MovingPart& part = parts[i];
        if (!(part.mask & mask)) return;
        const auto visit_shapes = [&part](const auto& from, const auto& along, double reach, const auto& visit) {
          part.shape_boxes.visit_intersected(from.template cast<float>(), along.template cast<float>(),
                                             static_cast<float>(reach), visit);
        };
        cast_at_part(part, at.parts[i], ray.origin, ray.direction, reach_m, best, visit_shapes);
      };
      at.boxes.visit_intersected(ray.origin.cast<float>(), ray.direction.cast<float>(), static_cast<float>(reach_m),
                                 cast_at);
    });
  }

  std::optional<RayHit> complete(const std::optional<RayHit>& hit, const Targets& targets, const Ray& ray) const {
    const Poses& at = *targets.poses;
    if (!targets.cone.contains(ray.origin, ray.direction))
      return complete(hit, at, ray, targets.max_range_m, targets.mask);
    return with_parts(hit, ray.direction, targets.max_range_m, [&](double& reach_m, auto& best) {
      for (const Targets::Part& target : targets.parts) {
        const MovingPart& part = parts[target.index];
        const auto visit_shapes = [&](const auto& from, const auto& along, const double& reach, const auto& visit) {
          for (std::size_t k = target.begin; k < target.end; ++k) {
            if (intersects(part.wide_boxes[targets.shapes[k]], from, along, reach)) visit(targets.shapes[k]);
          }
        };
        cast_at_part(part, at.parts[target.index], ray.origin, ray.direction, reach_m, best, visit_shapes);
      }
    });
  }

  void add_targets(std::size_t index, Targets& targets) const {
    const MovingPart& part = parts[index];
    const BodyPose& pose = targets.poses->parts[index];
    const auto may_hit = [&](const Eigen::AlignedBox3d& box) {
      return targets.cone.may_hit(pose.position + pose.rotation * box.center(), box.diagonal().norm() / 2.0,
                                  targets.max_range_m);
    };
    if (!(part.mask & targets.mask) || !may_hit(part.box)) return;
    const std::size_t begin = targets.shapes.size();
    for (std::size_t shape = 0; shape < part.shapes.size(); ++shape) {
      if (may_hit(part.wide_boxes[shape])) targets.shapes.push_back(shape);
    }
    if (part.assets || targets.shapes.size() > begin) targets.parts.push_back({index, begin, targets.shapes.size()});
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
  return cast(*impl_->poses, origin, direction, max_range_m, mask);
}

std::shared_ptr<const LidarScene::Poses> LidarScene::poses() const {
  impl_->are_given_out = true;
  return impl_->poses;
}

std::optional<RayHit> LidarScene::cast(const Poses& poses, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction, double max_range_m, std::uint32_t mask) const {
  return impl_->complete(impl_->cast_at_static(origin, direction, max_range_m, mask), poses, {origin, direction},
                         max_range_m, mask);
}

LidarScene::Targets LidarScene::targets(std::shared_ptr<const Poses> poses, const RayCone& cone, double max_range_m,
                                        std::uint32_t mask) const {
  Targets targets{.poses = std::move(poses), .cone = cone, .max_range_m = max_range_m, .mask = mask};
  for (std::size_t i = 0; i < impl_->parts.size(); ++i) impl_->add_targets(i, targets);
  return targets;
}

std::optional<RayHit> LidarScene::cast(const Targets& targets, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) const {
  return impl_->complete(impl_->cast_at_static(origin, direction, targets.max_range_m, targets.mask), targets,
                         {origin, direction});
}

void LidarScene::cast(const Targets& targets, std::span<const Ray> rays, std::span<std::optional<RayHit>> hits) const {
  if (targets.mask & kRayScenery) impl_->static_scene->cast(rays, targets.max_range_m, hits);
  else std::ranges::fill(hits, std::nullopt);
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = impl_->complete(hits[i], targets, rays[i]);
}

}  // namespace patrol::sim
