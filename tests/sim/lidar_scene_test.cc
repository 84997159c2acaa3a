#include "sim/lidar_scene.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "io/urdf.h"
#include "tests/sim/small_world.h"
#include "tests/support/simulated_quadruped.h"

namespace patrol::sim::lidar_scene_test {
namespace {

constexpr double kRange_m = 40.0;
constexpr mjtByte kSeen[mjNGROUP] = {1, 0, 1, 0, 1, 0};

/// Every type of geom, still and turned, on the ground; and the same on a free body, a mocap body and an arm
/// on it.
const std::string kMesh = R"(<mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 0.7  1 1 0.2"/>)";
const std::string kShapes = R"(<geom type="box" pos="3 0 0.5" size="0.3 0.5 0.6" euler="10 20 30"/>
  <geom type="sphere" pos="0 3 0.5" size="0.4"/>
  <geom type="capsule" pos="-3 1 0.6" size="0.2 0.5" euler="40 0 15"/>
  <geom type="cylinder" pos="1 -3 0.6" size="0.3 0.7" euler="0 75 40"/>
  <geom type="ellipsoid" pos="-2 -3 0.8" size="0.2 0.5 0.8" euler="30 30 0"/>
  <geom type="mesh" mesh="wedge" pos="-4 -2 0.2" euler="0 0 50"/>)";
const std::string kEveryShape = R"(<geom type="plane" size="50 50 1"/>)" + kShapes +
                                R"(<body pos="2 6 1" euler="5 0 0"><freejoint/>)" + kShapes + "</body>" +
                                R"(<body name="actor" mocap="true" pos="-7 2 0.5" euler="0 0 100">)" + kShapes +
                                "</body>" + R"(<body pos="4 -7 0"><joint name="turn" axis="0 0 1"/>)" + kShapes +
                                R"(<body pos="0 0 1"><joint axis="0 1 0"/>)" + kShapes + "</body></body>";

Eigen::Vector3d random_direction(const RandomStream& random, std::uint64_t ray) {
  return Eigen::Vector3d(random.normal(ray, 0), random.normal(ray, 1), random.normal(ray, 2)).normalized();
}

double mujoco_range(const mjModel& model, const mjData& data, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& direction, int* geom = nullptr) {
  int hit = -1;
  const mjtNum distance = mj_ray(&model, &data, origin.data(), direction.data(), kSeen, 1, -1, &hit, nullptr);
  if (geom != nullptr) *geom = hit;
  return distance < 0.0 || distance > kRange_m ? kRange_m : distance;
}

struct Agreement {
  int hits = 0;
  int beyond_1_mm = 0;     ///< rays whose ranges differ by more
  int unexplained = 0;     ///< rays beyond 1 mm that MuJoCo does not reproduce 0.1 mm beside them either
  int other_geom = 0;      ///< ranges agree, but another geom is named
  double largest_m = 0.0;  ///< among those that agree
};

/// Casts a ray with both. At an edge float and double may part; then MuJoCo's own neighbouring rays part as
/// well.
void compare(const LidarScene& scene, const mjModel& model, const mjData& data, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction, Agreement& agreement) {
  const std::optional<RayHit> hit = scene.cast(origin, direction, kRange_m, kRayEverything);
  const double ours = hit ? hit->distance_m : kRange_m;
  int geom = -1;
  const double theirs = mujoco_range(model, data, origin, direction, &geom);
  if (hit) ++agreement.hits;
  if (std::abs(ours - theirs) <= 1e-3) {
    agreement.largest_m = std::max(agreement.largest_m, std::abs(ours - theirs));
    if (hit && hit->geom != geom) ++agreement.other_geom;
    return;
  }
  ++agreement.beyond_1_mm;
  const Eigen::Vector3d side = direction.unitOrthogonal(), up = direction.cross(side);
  for (int i = 0; i < 16; ++i) {
    const double angle = i * std::numbers::pi / 8.0;
    const Eigen::Vector3d beside = origin + 1e-4 * (std::cos(angle) * side + std::sin(angle) * up);
    if (std::abs(mujoco_range(model, data, beside, direction) - ours) <= 1e-3) return;
  }
  ++agreement.unexplained;
}

TEST(LidarScene, HitsEveryTypeOfGeomWithin1MillimetreOfMjRayStillOrMoving) {
  SmallWorld world(kEveryShape, kMesh);
  const RandomStream random(1, "rays");
  Agreement agreement;
  for (int configuration = 0; configuration < 10; ++configuration) {
    for (int i = 0; i < 7; ++i)
      world.data->qpos[i] += 0.3 * random.normal(1000000, static_cast<std::uint64_t>(i + 10 * configuration));
    mj_normalizeQuat(world.model.get(), world.data->qpos);
    world.data->qpos[7] += 0.5;
    world.data->qpos[8] += 0.3;
    world.data->mocap_pos[0] += 0.4;
    mj_forward(world.model.get(), world.data.get());
    world.scene.update(*world.data);
    for (std::uint64_t ray = 0; ray < 3000; ++ray) {
      const std::uint64_t draw = ray + 3000 * static_cast<std::uint64_t>(configuration);
      const Eigen::Vector3d origin(8.0 * random.uniform(draw, 10) - 4.0, 8.0 * random.uniform(draw, 11) - 4.0,
                                   0.1 + 2.0 * random.uniform(draw, 12));
      compare(world.scene, *world.model, *world.data, origin, random_direction(random, draw), agreement);
    }
  }
  EXPECT_GT(agreement.hits, 15000);
  EXPECT_EQ(agreement.unexplained, 0);
  EXPECT_LE(agreement.beyond_1_mm, 3);
  EXPECT_LE(agreement.other_geom, 3);
  EXPECT_LT(agreement.largest_m, 1e-4);
}

TEST(LidarScene, InTheStreetWithRobotAndTrafficUnderWayItIsWithin1MillimetreOfMjRay) {
  WalkingRobot robot(assemble_model(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart));
  const mjModel& view = robot.view();
  const DataPtr data = make_data(view);
  LidarScene scene(view);
  const RandomStream random(2, "rays");
  Agreement agreement;
  for (int stop = 0; stop < 4; ++stop) {
    for (int i = 0; i < view.nmocap; ++i) {
      robot.data().mocap_pos[3 * i] = robot.data().qpos[0] + 3.0 * random.normal(900 + stop, 3 * i);
      robot.data().mocap_pos[3 * i + 1] = robot.data().qpos[1] + 3.0 * random.normal(900 + stop, 3 * i + 1);
    }
    for (int tick = 0; tick < 50; ++tick)
      robot.step({.stamp = {}, .vx_mps = 0.5, .vy_mps = 0.0, .yaw_rate_radps = 0.5});
    scene.update(robot.data());  // from the state of the physics model
    std::copy_n(robot.data().qpos, view.nq, data->qpos);
    std::copy_n(robot.data().mocap_pos, 3 * view.nmocap, data->mocap_pos);
    std::copy_n(robot.data().mocap_quat, 4 * view.nmocap, data->mocap_quat);
    mj_kinematics(&view, data.get());
    const Eigen::Vector3d lidar = robot.T_world_body() * Eigen::Vector3d(-0.02, 0.0, 0.25);
    for (int beam = 0; beam < 600; ++beam) {
      const double angle = 2.0 * std::numbers::pi * beam / 600.0;
      compare(scene, view, *data, lidar, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.02).normalized(),
              agreement);
    }
    for (std::uint64_t ray = 0; ray < 600; ++ray) {
      const std::uint64_t draw = ray + 600 * static_cast<std::uint64_t>(stop);
      const Eigen::Vector3d origin(60.0 * random.uniform(draw, 10), 100.0 * random.uniform(draw, 11),
                                   0.2 + 2.0 * random.uniform(draw, 12));
      compare(scene, view, *data, origin, random_direction(random, draw), agreement);
    }
  }
  EXPECT_GT(agreement.hits, 2500);
  EXPECT_EQ(agreement.unexplained, 0);
  EXPECT_LE(agreement.beyond_1_mm, 8);
  EXPECT_LT(agreement.largest_m, 5e-4);
}

TEST(LidarScene, InTheTunnelItIsWithin1MillimetreOfMjRayOnLiningRockAndInvert) {
  const ModelPtr model = compile(*load_spec(PATROL_SOURCE_DIR "/worlds/tunnel/tunnel.xml"), "tunnel");
  const DataPtr data = make_data(*model);
  mj_kinematics(model.get(), data.get());
  LidarScene scene(*model);
  scene.update(*data);
  const RandomStream random(5, "rays");
  Agreement agreement;
  for (std::uint64_t ray = 0; ray < 3000; ++ray) {
    const double x = 2.0 + 150.0 * random.uniform(ray, 10), bend = std::max(0.0, x - 80.0);
    const Eigen::Vector3d origin(x, bend * bend / 800.0 + 8.0 * random.uniform(ray, 11) - 4.0,
                                 0.3 + 1.2 * random.uniform(ray, 12));
    compare(scene, *model, *data, origin, random_direction(random, ray), agreement);
  }
  EXPECT_GT(agreement.hits, 2500);
  EXPECT_EQ(agreement.unexplained, 0);
  EXPECT_LE(agreement.beyond_1_mm, 8);
  EXPECT_LT(agreement.largest_m, 5e-4);
}

/// 200 cones of 50 rays, a tenth of which leave their cone.
TEST(LidarScene, RaysOfAConeHitWhatTheyHitWithoutIt) {
  SmallWorld world(kEveryShape, kMesh);
  const auto poses = world.scene.poses();
  const RandomStream random(6, "rays");
  int hits = 0, left_out = 0;
  for (std::uint64_t bundle = 0; bundle < 200; ++bundle) {
    const double half_angle = 0.02 + 0.5 * random.uniform(bundle, 1);
    const RayCone cone{.center = 3.0 * random_direction(random, 1000 + bundle) + Eigen::Vector3d(0, 0, 3.2),
                       .radius_m = 0.05,
                       .axis = random_direction(random, 2000 + bundle),
                       .cosine = std::cos(half_angle),
                       .sine = std::sin(half_angle)};
    const LidarScene::Targets targets = world.scene.targets(poses, cone, kRange_m, kRayEverything);
    if (targets.parts.size() < 3) ++left_out;
    for (std::uint64_t ray = 0; ray < 50; ++ray) {
      const std::uint64_t draw = 10000 + 50 * bundle + ray;
      const Eigen::Vector3d origin = cone.center + 0.05 * random.uniform(draw, 3) * random_direction(random, draw);
      const double turn = (ray % 10 == 0 ? 1.5 : 0.999) * half_angle * random.uniform(draw, 4);
      const Eigen::Vector3d side = cone.axis.cross(random_direction(random, draw + 50000)).normalized();
      const Eigen::Vector3d direction = (std::cos(turn) * cone.axis + std::sin(turn) * side).normalized();
      const auto fast = world.scene.cast(targets, origin, direction);
      const auto full = world.scene.cast(*poses, origin, direction, kRange_m, kRayEverything);
      ASSERT_EQ(fast.has_value(), full.has_value()) << "cone " << bundle << ", ray " << ray;
      if (!full) continue;
      if (world.model->body_weldid[world.model->geom_bodyid[full->geom]] != 0) ++hits;
      EXPECT_EQ(fast->distance_m, full->distance_m);
      EXPECT_EQ(fast->geom, full->geom);
      EXPECT_EQ(fast->normal, full->normal);
    }
  }
  EXPECT_GT(hits, 400) << "rays that hit a moving body";
  EXPECT_GT(left_out, 100) << "cones that miss a body";
}

/// Numbers of rays that fill no packet, with and without scenery. Two rays in ten thousand may name the other of two
/// surfaces that intersect where both are hit.
TEST(LidarScene, RaysCastTogetherHitWhatTheyHitAlone) {
  SmallWorld world(kEveryShape, kMesh);
  const RandomStream random(7, "rays");
  int hits = 0, others = 0;
  for (std::uint64_t bundle = 0; bundle < 600; ++bundle) {
    const RayCone cone{.center = 3.0 * random_direction(random, bundle) + Eigen::Vector3d(0, 0, 3.2),
                       .radius_m = 1e-6,
                       .axis = random_direction(random, 1000 + bundle),
                       .cosine = std::cos(0.2),
                       .sine = std::sin(0.2)};
    const std::uint32_t mask = bundle % 10 == 0 ? kRayEverything & ~kRayScenery : kRayEverything;
    const LidarScene::Targets targets = world.scene.targets(world.scene.poses(), cone, kRange_m, mask);
    const Eigen::Vector3d side = cone.axis.unitOrthogonal();
    std::vector<Ray> rays;
    for (std::uint64_t ray = 0; ray < bundle % 37; ++ray) {
      const double angle = 0.01 * static_cast<double>(ray) - 0.18;
      rays.push_back({cone.center, std::cos(angle) * cone.axis + std::sin(angle) * side});
    }
    std::vector<std::optional<RayHit>> together(rays.size(), RayHit{.distance_m = -1.0, .geom = -1, .normal = {}});
    world.scene.cast(targets, rays, together);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto alone = world.scene.cast(targets, rays[i].origin, rays[i].direction);
      ASSERT_EQ(together[i].has_value(), alone.has_value()) << "bundle " << bundle << ", ray " << i;
      if (!alone) continue;
      ++hits;
      EXPECT_EQ(together[i]->distance_m, alone->distance_m);
      if (together[i]->geom != alone->geom || together[i]->normal != alone->normal) ++others;
    }
  }
  EXPECT_GT(hits, 4000);
  EXPECT_LE(others, 2);
}

TEST(LidarScene, NormalsAreThoseOfMuJoCoAndLookTowardsTheRaysOrigin) {
  const SmallWorld world(kEveryShape, kMesh);
  const RandomStream random(3, "rays");
  int compared = 0;
  for (std::uint64_t ray = 0; ray < 4000; ++ray) {
    const Eigen::Vector3d origin(0, 0, 2.5), direction = random_direction(random, ray);
    const std::optional<RayHit> hit = world.scene.cast(origin, direction, kRange_m, kRayEverything);
    mjtNum normal[3];
    int geom = -1;
    const mjtNum distance =
        mj_ray(world.model.get(), world.data.get(), origin.data(), direction.data(), kSeen, 1, -1, &geom, normal);
    if (!hit || distance < 0.0 || geom != hit->geom) continue;
    EXPECT_LE(hit->normal.dot(direction), 0.0);
    if (std::abs(Eigen::Vector3d(normal).dot(direction)) < 0.05)
      continue;  // grazing a round shape magnifies the float's loss
    EXPECT_GT(std::abs(Eigen::Vector3d(normal).dot(hit->normal)), 0.999) << "geom " << geom;
    ++compared;
  }
  EXPECT_GT(compared, 1500);
}

TEST(LidarScene, AMaskHidesTheRobotOrOneOfItsLidars) {
  const SmallWorld world(R"(<geom type="box" pos="5 0 0" size="0.5 1 1"/>
    <body name="base_link" pos="2 0 0"><freejoint/><geom group="4" size="0.1"/>
      <body name="lidar" pos="-1 0 0"><geom group="4" size="0.1"/></body></body>)");
  const auto range = [&](std::uint32_t mask) { return world.scene.cast({0, 0, 0}, {1, 0, 0}, 30.0, mask)->distance_m; };
  EXPECT_NEAR(range(kRayEverything), 0.9, 1e-6);
  EXPECT_NEAR(range(kRayEverything & ~kRayLidar2d), 1.9, 1e-6);
  EXPECT_NEAR(range(kRayScenery), 4.5, 1e-6);
}

TEST(LidarScene, SeesGroups0And2AndTheRobotsLooksButNothingTransparentOrForTheEyeOnly) {
  const SmallWorld world(R"(<geom type="box" pos="1 0 0" size="0.1 1 1" group="1"/>
    <geom type="box" pos="2 0 0" size="0.1 1 1" group="3"/>
    <geom type="box" pos="3 0 0" size="0.1 1 1" rgba="1 1 1 0"/>
    <geom type="box" pos="4 0 0" size="0.1 1 1" group="5"/>
    <geom type="box" pos="5 0 0" size="0.1 1 1" group="2"/>)");
  EXPECT_NEAR(world.scene.cast({0, 0, 0}, {1, 0, 0}, 30.0, kRayEverything)->distance_m, 4.9, 1e-6);
}

TEST(LidarScene, NothingLiesBeyondTheRange) {
  const SmallWorld world(R"(<geom type="box" pos="5 0 0" size="0.5 1 1"/>)");
  EXPECT_TRUE(world.scene.cast({0, 0, 0}, {1, 0, 0}, 4.6, kRayEverything));
  EXPECT_FALSE(world.scene.cast({0, 0, 0}, {1, 0, 0}, 4.4, kRayEverything));
  EXPECT_FALSE(world.scene.cast({0, 0, 0}, {-1, 0, 0}, 30.0, kRayEverything));
}

/// Hills of 7 x 5 corners, three times as long as wide, turned and tilted, so that no wall or cell is like
/// another.
const std::string kHills = R"(<hfield name="hills" nrow="5" ncol="7" size="6 2 1.2 0.5" elevation="
  0.0 0.2 0.1 0.4 0.6 0.3 0.9   0.3 0.8 0.2 0.5 0.1 0.7 0.2   0.5 0.1 1.0 0.3 0.8 0.2 0.4
  0.9 0.4 0.6 0.0 0.5 0.9 0.1   0.2 0.7 0.3 0.6 0.2 0.4 0.8"/>)";
const std::string kHillside =
    R"(<geom name="hillside" type="hfield" hfield="hills" pos="1 -0.5 0.3" euler="8 -5 35"/>)";

TEST(LidarScene, AHeightFieldIsHitWithin1MillimetreOfMjRayFromAboveBesideBelowAndWithin) {
  const SmallWorld world(kHillside, kHills);
  const RandomStream random(4, "rays");
  Agreement agreement;
  for (std::uint64_t ray = 0; ray < 20000; ++ray) {
    const Eigen::Vector3d origin(16.0 * random.uniform(ray, 10) - 8.0, 10.0 * random.uniform(ray, 11) - 5.0,
                                 5.0 * random.uniform(ray, 12) - 1.5);
    const Eigen::Vector3d target(1.0 + 5.0 * random.normal(ray, 13), -0.5 + 2.0 * random.normal(ray, 14), 0.6);
    compare(world.scene, *world.model, *world.data, origin, (target - origin).normalized(), agreement);
  }
  EXPECT_GT(agreement.hits, 10000);
  EXPECT_EQ(agreement.unexplained, 0);
  EXPECT_LE(agreement.beyond_1_mm, 5);
  EXPECT_LT(agreement.largest_m, 1e-4);
}

TEST(LidarScene, StraightDownOnAHeightFieldMeetsTheCornersWhereTheFilePutsThem) {
  // Corners 2 m and 1 m apart; the file's last row lies at the lowest y. Heights 0 ... 1.2 m over the geom's
  // origin.
  const SmallWorld world(R"(<geom type="hfield" hfield="hills"/>)", kHills);
  const auto height = [&](double x, double y) {
    return 5.0 - world.scene.cast({x, y, 5.0}, {0, 0, -1}, 9.0, kRayEverything)->distance_m;
  };
  EXPECT_NEAR(height(-2.0, 0.0), 1.0 * 1.2, 1e-6);
  EXPECT_NEAR(height(-2.0, -1.0), 0.6 * 1.2, 1e-6);
  EXPECT_NEAR(height(4.0, 1.0), 0.7 * 1.2, 1e-6);
  EXPECT_NEAR(height(-1.0, 0.0), (1.0 + 0.3) / 2.0 * 1.2, 1e-6);
}

TEST(LidarScene, AShapeWithoutSurfaceToCastAtIsRefusedByItsNumber) {
  const SmallWorld world(R"(<geom type="sphere" size="1"/>)");
  ModelPtr odd(mj_copyModel(nullptr, world.model.get()));
  odd->geom_type[0] = mjGEOM_SDF;
  try {
    LidarScene scene(*odd);
    FAIL() << "a signed distance field was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "geom 0: shape type not supported by the lidar: must be one of sphere, capsule, cylinder, ellipsoid, "
                 "box, plane, "
                 "mesh, height field");
  }
}

}  // namespace
}  // namespace patrol::sim::lidar_scene_test
