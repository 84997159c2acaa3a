#include "sim/embree_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::sim {
namespace {

/// Returns the half size of the bounding box of a round geom, along the axes of its frame.
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
  const Eigen::Map<const Eigen::Vector3d> center(geom.position);
  const Eigen::Vector3d half =
      half_extent(geom).array() + 1e-4;  // exceeds the rounding error of float in a world of one kilometer
  const Eigen::Vector3f lower = (center - half).cast<float>(), upper = (center + half).cast<float>();
  *arguments->bounds_o = {.lower_x = lower.x(),
                          .lower_y = lower.y(),
                          .lower_z = lower.z(),
                          .align0 = 0.0f,
                          .upper_x = upper.x(),
                          .upper_y = upper.y(),
                          .upper_z = upper.z(),
                          .align1 = 0.0f};
}

/// Tests one or several rays against a round geom.
void intersect_round(const RTCIntersectFunctionNArguments* arguments) {
  const auto& geom = *static_cast<const PlacedGeom*>(arguments->geometryUserPtr);
  const unsigned count = arguments->N;
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments->rayhit, count);
  for (unsigned i = 0; i < count; ++i) {
    if (arguments->valid[i] == 0) continue;
    const mjtNum origin[3] = {RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i),
                              RTCRayN_org_z(rays, count, i)};
    const mjtNum direction[3] = {RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i),
                                 RTCRayN_dir_z(rays, count, i)};
    float& tfar = RTCRayN_tfar(rays, count, i);
    mjtNum normal[3];
    const mjtNum distance = mju_rayGeom(geom.position, geom.rotation, geom.size, origin, direction, geom.type, normal);
    if (distance < RTCRayN_tnear(rays, count, i) || distance >= tfar || distance < 0.0) continue;
    tfar = static_cast<float>(distance);
    RTCHitN_Ng_x(hits, count, i) = static_cast<float>(normal[0]);
    RTCHitN_Ng_y(hits, count, i) = static_cast<float>(normal[1]);
    RTCHitN_Ng_z(hits, count, i) = static_cast<float>(normal[2]);
    RTCHitN_geomID(hits, count, i) = arguments->geomID;
    RTCHitN_primID(hits, count, i) = 0;
  }
}

/// Vertices and faces of one geom, in the frame of its Embree scene.
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

/// Builder of a height field's triangles. MuJoCo's rows run along y, its columns along x.
class HeightFieldTriangles {
 public:
  HeightFieldTriangles(const mjModel& model, int hfield)
      : heights_(model.hfield_data + model.hfield_adr[hfield]),
        size_(model.hfield_size + 4 * hfield),
        rows_(static_cast<unsigned>(model.hfield_nrow[hfield])),
        columns_(static_cast<unsigned>(model.hfield_ncol[hfield])) {}

  /// Builds the surface, walls from its edges down to height 0, and the base box of MuJoCo. Each cell is split along
  /// the diagonal of mj_ray, from (row, column) to (row + 1, column + 1).
  Triangles make() {
    add_surface();
    for (unsigned column = 0; column + 1 < columns_; ++column) {
      for (const unsigned row : {0u, rows_ - 1}) add_wall(index(row, column), index(row, column + 1));
    }
    for (unsigned row = 0; row + 1 < rows_; ++row) {
      for (const unsigned column : {0u, columns_ - 1}) add_wall(index(row, column), index(row + 1, column));
    }
    add_base();
    return std::move(made_);
  }

 private:
  unsigned index(unsigned row, unsigned column) const { return row * columns_ + column; }

  void add_surface() {
    for (unsigned row = 0; row < rows_; ++row) {
      for (unsigned column = 0; column < columns_; ++column) {
        made_.corners.emplace_back(static_cast<float>(2.0 * size_[0] * column / (columns_ - 1) - size_[0]),
                                   static_cast<float>(2.0 * size_[1] * row / (rows_ - 1) - size_[1]),
                                   static_cast<float>(heights_[index(row, column)] * size_[2]));
      }
    }
    for (unsigned row = 0; row + 1 < rows_; ++row) {
      for (unsigned column = 0; column + 1 < columns_; ++column) {
        const unsigned here = index(row, column), across = index(row + 1, column + 1);
        made_.faces.push_back({here, index(row, column + 1), across});
        made_.faces.push_back({here, across, index(row + 1, column)});
      }
    }
  }

  /// Adds a wall below the edge between two vertices of the surface.
  void add_wall(unsigned a, unsigned b) {
    const auto foot = static_cast<unsigned>(made_.corners.size());
    for (const unsigned corner : {a, b}) {
      const Eigen::Vector3f top = made_.corners[corner];
      made_.corners.emplace_back(top.x(), top.y(), 0.0f);
    }
    made_.faces.push_back({a, b, foot + 1});
    made_.faces.push_back({a, foot + 1, foot});
  }

  void add_base() {
    const mjtNum half[3] = {size_[0], size_[1], size_[3] / 2.0};
    const auto first = static_cast<unsigned>(made_.corners.size());
    const Triangles box = box_triangles(half);
    for (const Eigen::Vector3f& corner : box.corners) {
      made_.corners.emplace_back(corner - Eigen::Vector3f(0.0f, 0.0f, static_cast<float>(half[2])));
    }
    for (const auto& [a, b, c] : box.faces) made_.faces.push_back({first + a, first + b, first + c});
  }

  const float* heights_;  ///< [row][column], 0 ... 1
  const mjtNum* size_;    ///< half size along x, half size along y, maximum height, base thickness
  unsigned rows_, columns_;
  Triangles made_;
};

Triangles triangles_of(const mjModel& model, const PlacedGeom& placed) {
  switch (placed.type) {
    case mjGEOM_BOX:
      return box_triangles(placed.size);
    case mjGEOM_PLANE:
      return plane_triangles(placed.size);
    case mjGEOM_MESH:
      return mesh_triangles(model, model.geom_dataid[placed.geom]);
    case mjGEOM_HFIELD:
      return HeightFieldTriangles(model, model.geom_dataid[placed.geom]).make();
    default:
      throw InputError(
          fmt::format("geom {}: shape type not supported by the lidar: must be one of sphere, capsule, cylinder, "
                      "ellipsoid, box, plane, mesh, height field",
                      placed.geom));
  }
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

/// Writes ray `i` of a packet.
void set_ray(const Ray& ray, double max_range_m, std::size_t i, RTCRayHit8& query) {
  query.ray.org_x[i] = static_cast<float>(ray.origin.x());
  query.ray.org_y[i] = static_cast<float>(ray.origin.y());
  query.ray.org_z[i] = static_cast<float>(ray.origin.z());
  query.ray.dir_x[i] = static_cast<float>(ray.direction.x());
  query.ray.dir_y[i] = static_cast<float>(ray.direction.y());
  query.ray.dir_z[i] = static_cast<float>(ray.direction.z());
  query.ray.tfar[i] = static_cast<float>(max_range_m);
  query.ray.mask[i] = ~0u;
  query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace

bool is_analytic(int type) {
  return type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE || type == mjGEOM_CYLINDER || type == mjGEOM_ELLIPSOID;
}

bool is_asset(int type) { return !is_analytic(type) && type != mjGEOM_BOX && type != mjGEOM_PLANE; }

EmbreeScene::EmbreeScene(RTCDevice device, RTCBuildQuality quality) : device_(device), scene_(rtcNewScene(device)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, quality);
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

void EmbreeScene::add(const mjModel& model, const PlacedGeom& placed) {
  RTCGeometry geometry = is_analytic(placed.type) ? make_round(placed) : make_triangles(model, placed);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  geoms_.push_back(placed.geom);
}

void EmbreeScene::build() { rtcCommitScene(scene_); }

std::optional<RayHit> EmbreeScene::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                        double max_range_m) const {
  RTCIntersectContext context{};
  rtcInitIntersectContext(&context);
  RTCRayHit query = make_query(origin, direction, max_range_m);
  rtcIntersect1(scene_, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return RayHit{.distance_m = query.ray.tfar,
                .geom = geoms_[query.hit.geomID],
                .normal = Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized().cast<double>()};
}

void EmbreeScene::cast(std::span<const Ray> rays, double max_range_m, std::span<std::optional<RayHit>> hits) const {
  constexpr std::size_t kPacket = 8;  // rays of one instruction of kEmbreeConfiguration (lidar_scene.cc)
  RTCIntersectContext context{};
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - begin);
    RTCRayHit8 query{};
    alignas(32) std::array<int, kPacket> valid{};
    for (std::size_t i = 0; i < count; ++i) set_ray(rays[begin + i], max_range_m, i, query), valid[i] = -1;
    rtcIntersect8(valid.data(), scene_, &context, &query);
    for (std::size_t i = 0; i < count; ++i) {
      std::optional<RayHit>& hit = hits[begin + i];
      hit.reset();
      if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hit = {.distance_m = query.ray.tfar[i],
             .geom = geoms_[query.hit.geomID[i]],
             .normal =
                 Eigen::Vector3f(query.hit.Ng_x[i], query.hit.Ng_y[i], query.hit.Ng_z[i]).normalized().cast<double>()};
    }
  }
}

RTCGeometry EmbreeScene::make_round(const PlacedGeom& placed) {
  rounds_.push_back(std::make_unique<PlacedGeom>(placed));
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, rounds_.back().get());
  rtcSetGeometryBoundsFunction(geometry, round_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_round);
  return geometry;
}

RTCGeometry EmbreeScene::make_triangles(const mjModel& model, const PlacedGeom& placed) const {
  const Triangles triangles = triangles_of(model, placed);
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
  void* faces = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                        triangles.faces.size());
  std::memcpy(faces, triangles.faces.data(), triangles.faces.size() * sizeof(triangles.faces[0]));
  return geometry;
}

}  // namespace patrol::sim
