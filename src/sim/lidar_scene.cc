#include "sim/lidar_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "sim/robot_model.h"

namespace patrol::sim {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// A geom of round shape in the frame of its Embree scene.
struct RoundGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

/// Everything that rides on one body (or, for body 0, stands still).
struct BodyScene {
  int body;
  std::uint32_t mask;
  RTCScene scene = nullptr;
  RTCGeometry instance = nullptr;
  std::vector<int> geoms;                  ///< [geometry in the scene]
  std::vector<std::unique_ptr<RoundGeom>> rounds;
  std::array<mjtNum, 7> pose{};            ///< last given to Embree
};

bool is_still(const mjModel& model, int body) {
  return model.body_weldid[body] == 0 && model.body_mocapid[model.body_rootid[body]] < 0;
}

bool is_seen(const mjModel& model, int geom) {
  const int group = model.geom_group[geom];
  const bool is_transparent = model.geom_rgba[4 * geom + 3] <= 0.0f;
  return group == kGroupLidarOnly || ((group == kGroupSolid || group == kGroupRobotVisual) && !is_transparent);
}

std::uint32_t mask_of(const mjModel& model, int body) {
  const int robot = mj_name2id(&model, mjOBJ_BODY, frame_id::kBody);
  if (robot < 0 || model.body_rootid[body] != model.body_rootid[robot]) return kRayScenery;
  const std::string_view name = mj_id2name(&model, mjOBJ_BODY, body);
  if (name == "lidar") return kRayLidar2d;
  return name == "lidar3d" ? kRayLidar3d : kRayRobot;
}

void round_bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto& geom = *static_cast<const RoundGeom*>(arguments->geometryUserPtr);
  const double reach = geom.type == mjGEOM_SPHERE    ? geom.size[0]
                       : geom.type == mjGEOM_CAPSULE ? geom.size[0] + geom.size[1]
                       : geom.type == mjGEOM_CYLINDER ? std::hypot(geom.size[0], geom.size[1])
                                                      : std::max({geom.size[0], geom.size[1], geom.size[2]});
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = static_cast<float>(geom.position[0] - reach);
  bounds.lower_y = static_cast<float>(geom.position[1] - reach);
  bounds.lower_z = static_cast<float>(geom.position[2] - reach);
  bounds.upper_x = static_cast<float>(geom.position[0] + reach);
  bounds.upper_y = static_cast<float>(geom.position[1] + reach);
  bounds.upper_z = static_cast<float>(geom.position[2] + reach);
}

void intersect_round(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& geom = *static_cast<const RoundGeom*>(arguments->geometryUserPtr);
  auto& ray_hit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  RTCRay& ray = ray_hit.ray;
  const mjtNum origin[3] = {ray.org_x, ray.org_y, ray.org_z};
  const mjtNum direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
  mjtNum normal[3];
  const mjtNum distance = mju_rayGeom(geom.position, geom.rotation, geom.size, origin, direction, geom.type, normal);
  if (distance < ray.tnear || distance >= ray.tfar || distance < 0.0) return;
  ray.tfar = static_cast<float>(distance);
  RTCHit& hit = ray_hit.hit;
  hit.Ng_x = static_cast<float>(normal[0]);
  hit.Ng_y = static_cast<float>(normal[1]);
  hit.Ng_z = static_cast<float>(normal[2]);
  hit.geomID = arguments->geomID;
  hit.primID = 0;
  hit.instID[0] = arguments->context->instID[0];
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
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) triangles.corners.emplace_back(Eigen::Map<const Eigen::Vector3f>(vertices + 3 * i));
  const int* faces = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  for (int i = 0; i < model.mesh_facenum[mesh]; ++i) {
    triangles.faces.push_back({static_cast<unsigned>(faces[3 * i]), static_cast<unsigned>(faces[3 * i + 1]),
                               static_cast<unsigned>(faces[3 * i + 2])});
  }
  return triangles;
}

bool is_round(int type) {
  return type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE || type == mjGEOM_CYLINDER || type == mjGEOM_ELLIPSOID;
}

}  // namespace

struct LidarScene::Impl {
  explicit Impl(const mjModel& view) : model(view), device(rtcNewDevice("threads=1")) {
    if (device == nullptr) throw std::runtime_error("Embree cannot start");
    place_still_bodies();
    for (int body = 0; body < model.nbody; ++body) {
      if (body == 0 || !is_still(model, body)) add_body(body);
    }
    top = rtcNewScene(device);
    rtcSetSceneFlags(top, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(top, RTC_BUILD_QUALITY_LOW);
    for (BodyScene& body : bodies) attach(body);
    rtcCommitScene(top);
  }

  ~Impl() {
    for (BodyScene& body : bodies) {
      rtcReleaseGeometry(body.instance);
      rtcReleaseScene(body.scene);
    }
    rtcReleaseScene(top);
    rtcReleaseDevice(device);
  }

  /// Poses in world of everything at the reference configuration, for what stands still.
  void place_still_bodies() {
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&model), mj_deleteData);
    mj_kinematics(&model, data.get());
    still_position.assign(data->geom_xpos, data->geom_xpos + 3 * model.ngeom);
    still_rotation.assign(data->geom_xmat, data->geom_xmat + 9 * model.ngeom);
  }

  void geom_pose(int geom, mjtNum position[3], mjtNum rotation[9]) const {
    if (is_still(model, model.geom_bodyid[geom])) {
      std::copy_n(still_position.data() + 3 * geom, 3, position);
      std::copy_n(still_rotation.data() + 9 * geom, 9, rotation);
    } else {
      std::copy_n(model.geom_pos + 3 * geom, 3, position);
      mju_quat2Mat(rotation, model.geom_quat + 4 * geom);
    }
  }

  void add_body(int body) {
    BodyScene part{.body = body, .mask = mask_of(model, body), .geoms = {}, .rounds = {}};
    for (int geom = 0; geom < model.ngeom; ++geom) {
      const int owner = model.geom_bodyid[geom];
      const bool belongs = body == 0 ? is_still(model, owner) : owner == body;
      if (!belongs || !is_seen(model, geom)) continue;
      if (part.scene == nullptr) {
        part.scene = rtcNewScene(device);
        rtcSetSceneFlags(part.scene, RTC_SCENE_FLAG_ROBUST);
      }
      add_geom(part, geom);
    }
    if (part.scene == nullptr) return;
    rtcCommitScene(part.scene);
    bodies.push_back(std::move(part));
  }

  void add_geom(BodyScene& part, int geom) {
    const int type = model.geom_type[geom];
    RTCGeometry geometry = nullptr;
    if (is_round(type)) {
      auto round = std::make_unique<RoundGeom>(RoundGeom{.geom = geom, .type = type, .position = {}, .rotation = {}, .size = {}});
      geom_pose(geom, round->position, round->rotation);
      std::copy_n(model.geom_size + 3 * geom, 3, round->size);
      geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
      rtcSetGeometryUserPrimitiveCount(geometry, 1);
      rtcSetGeometryUserData(geometry, round.get());
      rtcSetGeometryBoundsFunction(geometry, round_bounds, nullptr);
      rtcSetGeometryIntersectFunction(geometry, intersect_round);
      part.rounds.push_back(std::move(round));
    } else {
      geometry = make_triangles(geom);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(part.scene, geometry);
    rtcReleaseGeometry(geometry);
    part.geoms.push_back(geom);
  }

  RTCGeometry make_triangles(int geom) const {
    Triangles triangles;
    switch (model.geom_type[geom]) {
      case mjGEOM_BOX:
        triangles = box_triangles(model.geom_size + 3 * geom);
        break;
      case mjGEOM_PLANE:
        triangles = plane_triangles(model.geom_size + 3 * geom);
        break;
      case mjGEOM_MESH:
        triangles = mesh_triangles(model, model.geom_dataid[geom]);
        break;
      default:
        throw InputError(fmt::format("geom {}: the lidar cannot see shapes of this type", geom));
    }
    mjtNum position[3], rotation[9];
    geom_pose(geom, position, rotation);
    const Eigen::Vector3f p = Eigen::Map<const Eigen::Vector3d>(position).cast<float>();
    const Eigen::Matrix3f R = Eigen::Map<const Matrix3>(rotation).cast<float>();
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* coordinates = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), triangles.corners.size()));
    for (const Eigen::Vector3f& corner : triangles.corners) {
      Eigen::Map<Eigen::Vector3f> placed(coordinates);
      placed = p + R * corner;
      coordinates += 3;
    }
    void* faces = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                          triangles.faces.size());
    std::memcpy(faces, triangles.faces.data(), triangles.faces.size() * sizeof(triangles.faces[0]));
    return geometry;
  }

  void attach(BodyScene& part) {
    part.instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(part.instance, part.scene);
    rtcSetGeometryMask(part.instance, part.mask);
    set_transform(part, std::array<mjtNum, 7>{0, 0, 0, 1, 0, 0, 0});
    rtcAttachGeometry(top, part.instance);
  }

  static void set_transform(BodyScene& part, const std::array<mjtNum, 7>& pose) {
    part.pose = pose;
    mjtNum rotation[9];
    mju_quat2Mat(rotation, pose.data() + 3);
    const std::array<float, 12> columns = {
        static_cast<float>(rotation[0]), static_cast<float>(rotation[3]), static_cast<float>(rotation[6]),
        static_cast<float>(rotation[1]), static_cast<float>(rotation[4]), static_cast<float>(rotation[7]),
        static_cast<float>(rotation[2]), static_cast<float>(rotation[5]), static_cast<float>(rotation[8]),
        static_cast<float>(pose[0]),     static_cast<float>(pose[1]),     static_cast<float>(pose[2])};
    rtcSetGeometryTransform(part.instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(part.instance);
  }

  const mjModel& model;
  RTCDevice device;
  RTCScene top = nullptr;
  std::vector<BodyScene> bodies;  ///< [instance]
  std::vector<mjtNum> still_position, still_rotation;
};

LidarScene::LidarScene(const mjModel& view) : impl_(std::make_unique<Impl>(view)) {}
LidarScene::~LidarScene() = default;

const mjModel& LidarScene::model() const { return impl_->model; }
RTCSceneTy* LidarScene::still_scene() const { return impl_->bodies.front().scene; }

void LidarScene::update(const mjData& data) {
  bool has_moved = false;
  for (BodyScene& part : impl_->bodies) {
    if (part.body == 0) continue;
    std::array<mjtNum, 7> pose;
    std::copy_n(data.xpos + 3 * part.body, 3, pose.begin());
    std::copy_n(data.xquat + 4 * part.body, 4, pose.begin() + 3);
    if (pose == part.pose) continue;
    Impl::set_transform(part, pose);
    has_moved = true;
  }
  if (has_moved) rtcCommitScene(impl_->top);
}

std::optional<RayHit> LidarScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m,
                                       std::uint32_t mask) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(origin.x());
  query.ray.org_y = static_cast<float>(origin.y());
  query.ray.org_z = static_cast<float>(origin.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tfar = static_cast<float>(max_range_m);
  query.ray.mask = mask;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->top, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const BodyScene& part = impl_->bodies[query.hit.instID[0]];
  mjtNum rotation[9];
  mju_quat2Mat(rotation, part.pose.data() + 3);
  Eigen::Vector3d normal =
      Eigen::Map<const Matrix3>(rotation) * Eigen::Vector3d(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (normal.dot(direction) > 0.0) normal = -normal;
  return RayHit{.distance_m = query.ray.tfar, .geom = part.geoms[query.hit.geomID], .normal = normal};
}

}  // namespace patrol::sim
