#include "sim/lidar_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "sim/robot_model.h"

namespace patrol::sim {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// A geom placed in a frame: that of the world, or that of the body which it moves with.
struct PlacedGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

bool is_seen(const mjModel& model, int geom) {
  const int group = model.geom_group[geom];
  const bool is_transparent = model.geom_rgba[4 * geom + 3] <= 0.0f;
  return group == kGroupLidarOnly ||
         ((group == kGroupSolid || group == kGroupRobotVisual) && !is_transparent);
}

std::uint32_t mask_of(const mjModel& model, int body) {
  const int robot = mj_name2id(&model, mjOBJ_BODY, frame_id::kBody);
  if (robot < 0 || model.body_rootid[body] != model.body_rootid[robot]) return kRayScenery;
  const std::string_view name = mj_id2name(&model, mjOBJ_BODY, body);
  if (name == "lidar") return kRayLidar2d;
  return name == "lidar3d" ? kRayLidar3d : kRayRobot;
}

/// Half of the box, along the axes of its frame, that holds a geom of round shape.
Eigen::Vector3d half_extent(const PlacedGeom& geom) {
  const Eigen::Map<const Matrix3> R(geom.rotation);
  const Eigen::Map<const Eigen::Vector3d> size(geom.size);
  const Eigen::Vector3d axis = R.col(2).cwiseAbs();
  switch (geom.type) {
    case mjGEOM_SPHERE:
      return Eigen::Vector3d::Constant(size[0]);
    case mjGEOM_CAPSULE:
      return axis * size[1] + Eigen::Vector3d::Constant(size[0]);
    case mjGEOM_CYLINDER:
      return axis * size[1] + size[0] * (1.0 - axis.array().square()).max(0.0).sqrt().matrix();
    default:
      return (R * size.asDiagonal()).rowwise().norm();
  }
}

void round_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& geom = *static_cast<const PlacedGeom*>(arguments->geometryUserPtr);
  const Eigen::Map<const Eigen::Vector3d> centre(geom.position);
  const Eigen::Vector3d half =
      half_extent(geom).array() + 1e-4;  // more than a float loses over a world of a kilometre
  const Eigen::Vector3f lower = (centre - half).cast<float>(), upper = (centre + half).cast<float>();
  *arguments->bounds_o = {.lower_x = lower.x(),
                          .lower_y = lower.y(),
                          .lower_z = lower.z(),
                          .align0 = 0.0f,
                          .upper_x = upper.x(),
                          .upper_y = upper.y(),
                          .upper_z = upper.z(),
                          .align1 = 0.0f};
}

void intersect_round(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& geom = *static_cast<const PlacedGeom*>(arguments->geometryUserPtr);
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  RTCRay& ray = ray_hit.ray;
  const mjtNum origin[3] = {ray.org_x, ray.org_y, ray.org_z};
  const mjtNum direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
  mjtNum normal[3];
  const mjtNum distance =
      mju_rayGeom(geom.position, geom.rotation, geom.size, origin, direction, geom.type, normal);
  if (distance < ray.tnear || distance >= ray.tfar || distance < 0.0) return;
  ray.tfar = static_cast<float>(distance);
  RTCHit& hit = ray_hit.hit;
  hit.Ng_x = static_cast<float>(normal[0]);
  hit.Ng_y = static_cast<float>(normal[1]);
  hit.Ng_z = static_cast<float>(normal[2]);
  hit.geomID = arguments->geomID;
  hit.primID = 0;
}

/// Corners and faces of one geom, in the frame of its Embree scene.
struct Triangles {
  std::vector<Eigen::Vector3f> corners;
  std::vector<std::array<unsigned, 3>> faces;
};

Triangles box_triangles(const mjtNum half[3]) {
  Triangles box;
  for (int corner = 0; corner < 8; ++corner) {
    box.corners.emplace_back(static_cast<float>(corner & 1 ? half[0] : -half[0]),
                             static_cast<float>(corner & 2 ? half[1] : -half[1]),
                             static_cast<float>(corner & 4 ? half[2] : -half[2]));
  }
  box.faces = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
               {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

Triangles plane_triangles(const mjtNum half[3]) {
  constexpr float kEndless_m = 500.0f;
  const float x = half[0] > 0.0 ? static_cast<float>(half[0]) : kEndless_m;
  const float y = half[1] > 0.0 ? static_cast<float>(half[1]) : kEndless_m;
  return {.corners = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, .faces = {{0, 1, 2}, {0, 2, 3}}};
}

Triangles mesh_triangles(const mjModel& model, int mesh) {
  Triangles triangles;
  const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i)
    triangles.corners.emplace_back(Eigen::Map<const Eigen::Vector3f>(vertices + 3 * i));
  const int* faces = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  for (int i = 0; i < model.mesh_facenum[mesh]; ++i) {
    triangles.faces.push_back({static_cast<unsigned>(faces[3 * i]), static_cast<unsigned>(faces[3 * i + 1]),
                               static_cast<unsigned>(faces[3 * i + 2])});
  }
  return triangles;
}

bool is_round(int type) {
  return type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE || type == mjGEOM_CYLINDER ||
         type == mjGEOM_ELLIPSOID;
}

RTCRayHit make_query(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m) {
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(origin.x());
  query.ray.org_y = static_cast<float>(origin.y());
  query.ray.org_z = static_cast<float>(origin.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tfar = static_cast<float>(max_range_m);
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// Geoms that keep their places to each other, in Embree: triangles, and MuJoCo's own ray test for round
/// shapes.
class EmbreeScene {
 public:
  EmbreeScene(RTCDevice device, RTCBuildQuality quality) : device_(device), scene_(rtcNewScene(device)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, quality);
  }
  ~EmbreeScene() { rtcReleaseScene(scene_); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  void add(const mjModel& model, const PlacedGeom& placed) {
    RTCGeometry geometry = nullptr;
    if (is_round(placed.type)) {
      rounds_.push_back(std::make_unique<PlacedGeom>(placed));
      geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
      rtcSetGeometryUserPrimitiveCount(geometry, 1);
      rtcSetGeometryUserData(geometry, rounds_.back().get());
      rtcSetGeometryBoundsFunction(geometry, round_bounds, nullptr);
      rtcSetGeometryIntersectFunction(geometry, intersect_round);
    } else {
      geometry = make_triangles(model, placed);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    geoms_.push_back(placed.geom);
  }
  void build() { rtcCommitScene(scene_); }

  /// First hit nearer than `max_range_m`; the normal is not yet turned towards the origin.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query = make_query(origin, direction, max_range_m);
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return RayHit{
        .distance_m = query.ray.tfar,
        .geom = geoms_[query.hit.geomID],
        .normal =
            Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized().cast<double>()};
  }

  RTCScene handle() const { return scene_; }

 private:
  RTCGeometry make_triangles(const mjModel& model, const PlacedGeom& placed) const {
    const Triangles triangles = placed.type == mjGEOM_BOX ? box_triangles(placed.size)
                                : placed.type == mjGEOM_PLANE
                                    ? plane_triangles(placed.size)
                                    : mesh_triangles(model, model.geom_dataid[placed.geom]);
    const Eigen::Map<const Eigen::Vector3d> p(placed.position);
    const Eigen::Map<const Matrix3> R(placed.rotation);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* coordinates = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), triangles.corners.size()));
    for (const Eigen::Vector3f& corner : triangles.corners) {
      Eigen::Map<Eigen::Vector3f> in_scene(coordinates);
      in_scene = (p + R * corner.cast<double>()).cast<float>();
      coordinates += 3;
    }
    void* faces = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(unsigned), triangles.faces.size());
    std::memcpy(faces, triangles.faces.data(), triangles.faces.size() * sizeof(triangles.faces[0]));
    return geometry;
  }

  RTCDevice device_;
  RTCScene scene_;
  std::vector<int> geoms_;  ///< [geometry of the scene]
  std::vector<std::unique_ptr<PlacedGeom>> rounds_;
};

/// What moves as one: the geoms of a body and of everything welded to it.
struct MovingPart {
  int body;
  std::uint32_t mask;
  std::vector<PlacedGeom> geoms;                       ///< in the body's frame
  std::unique_ptr<EmbreeScene> meshes;                 ///< of `geoms`; null where there are none
  Eigen::AlignedBox3d box;                             ///< about all of them, in the body's frame
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the body, in world
  Matrix3 rotation = Matrix3::Identity();
};

/// True when the ray meets the box before `reach_m`, or begins in it.
bool meets(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
           double reach_m) {
  const Eigen::Array3d inverse = direction.array().inverse();
  const Eigen::Array3d to_lower = (box.min() - origin).array() * inverse,
                       to_upper = (box.max() - origin).array() * inverse;
  const double enter = to_lower.min(to_upper).maxCoeff(), leave = to_lower.max(to_upper).minCoeff();
  return !(enter > leave || leave < 0.0 || enter > reach_m);
}

/// The boxes about the moving parts, along the axes of the world, laid out for the compiler to test four at a
/// time.
class Boxes {
 public:
  void resize(std::size_t count) {
    for (auto* side : {&lower_, &upper_}) {
      for (std::vector<float>& axis : *side) axis.resize(count);
    }
  }

  void set(std::size_t i, const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
    constexpr double kFloatLoss_m = 1e-3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      lower_[axis][i] = static_cast<float>(centre[row] - half[row] - kFloatLoss_m);
      upper_[axis][i] = static_cast<float>(centre[row] + half[row] + kFloatLoss_m);
    }
  }

  /// Calls `visit` with the index of every box that the ray may meet before `reach_m`, or begins in.
  template <typename Visit>
  void visit_met(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach_m,
                 Visit visit) const {
    // A component of nothing is made very small: its inverse is finite, and no product below is 0 x infinity.
    const Eigen::Array3f inverse =
        (direction.array().abs() < 1e-12f).select(1e-12f, direction.array()).inverse();
    constexpr std::size_t kChunk = 64;
    std::array<float, kChunk> stay;  // length of the ray in the box; negative where it passes by
    for (std::size_t begin = 0; begin < lower_[0].size(); begin += kChunk) {
      const std::size_t count = std::min(kChunk, lower_[0].size() - begin);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = begin + k;
        const float x0 = (lower_[0][i] - origin.x()) * inverse.x(),
                    x1 = (upper_[0][i] - origin.x()) * inverse.x();
        const float y0 = (lower_[1][i] - origin.y()) * inverse.y(),
                    y1 = (upper_[1][i] - origin.y()) * inverse.y();
        const float z0 = (lower_[2][i] - origin.z()) * inverse.z(),
                    z1 = (upper_[2][i] - origin.z()) * inverse.z();
        const float enter =
            std::max(std::max(std::min(x0, x1), std::min(y0, y1)), std::max(std::min(z0, z1), 0.0f));
        const float leave =
            std::min(std::min(std::max(x0, x1), std::max(y0, y1)), std::min(std::max(z0, z1), reach_m));
        stay[k] = leave - enter;
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (stay[k] >= 0.0f) visit(begin + k);
      }
    }
  }

 private:
  std::array<std::vector<float>, 3> lower_, upper_;  ///< [axis][part]
};

}  // namespace

struct LidarScene::Impl {
  explicit Impl(const mjModel& view) : model(view), device(rtcNewDevice("threads=1")) {
    if (device == nullptr) throw std::runtime_error("Embree cannot start");
    still = std::make_unique<EmbreeScene>(device, RTC_BUILD_QUALITY_HIGH);
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&model), mj_deleteData);
    mj_kinematics(&model, data.get());
    for (int geom = 0; geom < model.ngeom; ++geom) {
      if (is_seen(model, geom)) add_geom(*data, geom);
    }
    still->build();
    for (MovingPart& part : parts) {
      if (part.meshes) part.meshes->build();
      enclose(part);
    }
    boxes.resize(parts.size());
    place(*data);
  }

  ~Impl() {
    still.reset();
    parts.clear();
    rtcReleaseDevice(device);
  }

  void add_geom(const mjData& data, int geom) {
    const int type = model.geom_type[geom];
    if (!is_round(type) && type != mjGEOM_BOX && type != mjGEOM_PLANE && type != mjGEOM_MESH) {
      throw InputError(fmt::format("geom {}: the lidar cannot see shapes of this type", geom));
    }
    const int body = model.body_weldid[model.geom_bodyid[geom]];
    PlacedGeom placed{.geom = geom, .type = type, .position = {}, .rotation = {}, .size = {}};
    std::copy_n(model.geom_size + 3 * geom, 3, placed.size);
    const Eigen::Map<const Matrix3> R_world_body(data.xmat + 9 * body),
        R_world_geom(data.geom_xmat + 9 * geom);
    const Eigen::Map<const Eigen::Vector3d> p_body(data.xpos + 3 * body), p_geom(data.geom_xpos + 3 * geom);
    Eigen::Map<Eigen::Vector3d>(placed.position) = R_world_body.transpose() * (p_geom - p_body);
    Eigen::Map<Matrix3>(placed.rotation) = R_world_body.transpose() * R_world_geom;
    if (body == 0) {
      still->add(model, placed);
      return;
    }
    MovingPart& part = part_of(body, mask_of(model, model.geom_bodyid[geom]));
    part.geoms.push_back(placed);
    if (type != mjGEOM_MESH) return;
    if (!part.meshes) part.meshes = std::make_unique<EmbreeScene>(device, RTC_BUILD_QUALITY_MEDIUM);
    part.meshes->add(model, placed);
  }

  MovingPart& part_of(int body, std::uint32_t mask) {
    for (MovingPart& part : parts) {
      if (part.body == body && part.mask == mask) return part;
    }
    return parts.emplace_back(
        MovingPart{.body = body, .mask = mask, .geoms = {}, .meshes = nullptr, .box = {}});
  }

  /// Puts a box about everything on a part.
  void enclose(MovingPart& part) const {
    for (const PlacedGeom& placed : part.geoms) {
      const Eigen::Map<const Eigen::Vector3d> position(placed.position),
          middle(model.geom_aabb + 6 * placed.geom);
      const Eigen::Map<const Matrix3> rotation(placed.rotation);
      const Eigen::Vector3d half =
          rotation.cwiseAbs() * Eigen::Map<const Eigen::Vector3d>(model.geom_aabb + 6 * placed.geom + 3);
      const Eigen::Vector3d centre = position + rotation * middle;
      part.box.extend(Eigen::AlignedBox3d(centre - half, centre + half));
    }
  }

  void place(const mjData& data) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      MovingPart& part = parts[i];
      part.position = Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * part.body);
      part.rotation = Eigen::Map<const Matrix3>(data.xmat + 9 * part.body);
      boxes.set(i, part.position + part.rotation * part.box.center(),
                part.rotation.cwiseAbs() * part.box.sizes() / 2.0);
    }
  }

  /// Takes the hit on a part for `best` if it is nearer than `reach_m`, and shortens that.
  static void cast_at(const MovingPart& part, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      double& reach_m, std::optional<RayHit>& best) {
    const Eigen::Vector3d from = part.rotation.transpose() * (origin - part.position);
    const Eigen::Vector3d along = part.rotation.transpose() * direction;
    if (!meets(part.box, from, along, reach_m)) return;
    bool is_nearer = false;
    if (part.meshes) {
      if (const auto hit = part.meshes->cast(from, along, reach_m)) {
        best = hit;
        reach_m = hit->distance_m;
        is_nearer = true;
      }
    }
    for (const PlacedGeom& geom : part.geoms) {
      if (geom.type == mjGEOM_MESH) continue;
      Eigen::Vector3d normal;
      const double distance_m = mju_rayGeom(geom.position, geom.rotation, geom.size, from.data(),
                                            along.data(), geom.type, normal.data());
      if (distance_m < 0.0 || distance_m >= reach_m) continue;
      best = RayHit{.distance_m = distance_m, .geom = geom.geom, .normal = normal};
      reach_m = distance_m;
      is_nearer = true;
    }
    if (is_nearer) best->normal = part.rotation * best->normal;
  }

  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m, std::uint32_t mask) const {
    std::optional<RayHit> best;
    if (mask & kRayScenery) best = still->cast(origin, direction, max_range_m);
    double reach_m = best ? best->distance_m : max_range_m;
    boxes.visit_met(origin.cast<float>(), direction.cast<float>(), static_cast<float>(reach_m),
                    [&](std::size_t i) {
                      if (parts[i].mask & mask) cast_at(parts[i], origin, direction, reach_m, best);
                    });
    if (best && best->normal.dot(direction) > 0.0) best->normal = -best->normal;
    return best;
  }

  const mjModel& model;
  RTCDevice device;
  std::unique_ptr<EmbreeScene> still;
  std::vector<MovingPart> parts;
  Boxes boxes;  ///< [part]
};

LidarScene::LidarScene(const mjModel& view) : impl_(std::make_unique<Impl>(view)) {}
LidarScene::~LidarScene() = default;

const mjModel& LidarScene::model() const { return impl_->model; }
RTCSceneTy* LidarScene::still_scene() const { return impl_->still->handle(); }
void LidarScene::update(const mjData& data) { impl_->place(data); }

std::optional<RayHit> LidarScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                       double max_range_m, std::uint32_t mask) const {
  return impl_->cast(origin, direction, max_range_m, mask);
}

}  // namespace patrol::sim
