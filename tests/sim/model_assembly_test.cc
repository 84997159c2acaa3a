#include "sim/model_assembly.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "sim/robot_model.h"
#include "tests/sim/rubble.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim::model_assembly_test {
namespace {

using testing::HasSubstr;

/// The street with its robot, assembled once for all tests that only look at it.
class StreetAssembly : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    street_ = std::make_unique<AssembledModel>(
        assemble_model(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart));
  }
  static void TearDownTestSuite() { street_.reset(); }
  static const AssembledModel& street() { return *street_; }

 private:
  static inline std::unique_ptr<AssembledModel> street_;
};

AssembledModel on_plane(const std::string& geoms, const Pose2& T_world_start = {}) {
  const test::TemporaryFile world("world.xml", make_flat_world(geoms));
  return assemble_model(world.path(), kRobotUrdf, io::load_robot_description(kRobotUrdf), T_world_start);
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Text of the error that the call throws.
template <typename Call>
std::string error_text(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_F(StreetAssembly, WithoutTexturesDiffersInImagesOnly) {
  const AssembledModel bare =
      assemble_model(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart, {}, Textures::kNone);
  const mjModel &with = *street().view, &without = *bare.view;
  EXPECT_GT(with.ntexdata, 1'000'000);
  EXPECT_EQ(without.ntexdata, 3 * (without.ntex + 5)) << "one texel each, six of the sky";
  ASSERT_EQ(with.ntex, without.ntex);
  ASSERT_EQ(with.ngeom, without.ngeom);
  ASSERT_EQ(with.nmat, without.nmat);
  EXPECT_TRUE(std::equal(with.geom_pos, with.geom_pos + 3 * with.ngeom, without.geom_pos));
  EXPECT_TRUE(std::equal(with.geom_matid, with.geom_matid + with.ngeom, without.geom_matid));
  EXPECT_TRUE(std::equal(with.mat_rgba, with.mat_rgba + 4 * with.nmat, without.mat_rgba));
  EXPECT_EQ(bare.start_qpos, street().start_qpos);
}

TEST(DropTextures, NeedsNoFileOfATexture) {
  const SpecPtr spec = parse_spec(R"(<mujoco><asset><texture name="sky" type="skybox" file="none.png" gridsize="3 4"/>
      <texture name="grid" type="2d" file="none.png" nchannel="4"/>
      <texture name="check" type="2d" builtin="checker" mark="edge" width="512" height="512"/>
      <material name="wall" texture="grid"/></asset>
      <worldbody><geom name="wall" type="box" size="1 1 1" material="wall"/></worldbody></mujoco>)");
  drop_textures(*spec);
  const ModelPtr model = compile(*spec, "test");
  EXPECT_EQ(model->ntex, 3);
  EXPECT_EQ(model->ntexdata, 3 * (6 + 1 + 1));
}

// MuJoCo itself notices a missing image only where it compiles the texture.
TEST(LoadSpec, RefusesATextureWithoutItsImageEvenWhereNoTextureIsCompiled) {
  const auto world = [](const std::string& directory, const std::string& file) {
    return test::TemporaryFile("world.xml", "<mujoco>\n<compiler texturedir='" + directory +
                                                "'/><asset>\n<texture name='wall' type='cube' file='" + file +
                                                "'/></asset></mujoco>");
  };
  const std::string images = PATROL_SOURCE_DIR "/worlds/tunnel/textures";
  EXPECT_EQ(error_text([&] { load_spec(world(images, "concrete.png").path()); }), "accepted");
  const test::TemporaryFile missing = world(images, "none.png");
  EXPECT_EQ(error_text([&] { load_spec(missing.path()); }),
            missing.path() + ": texture 'wall': " + images + "/none.png cannot be read (line 3)");
  const test::TemporaryFile beside = world("", "none.png");
  EXPECT_THAT(error_text([&] { load_spec(beside.path()); }),
              HasSubstr(std::filesystem::path(beside.path()).parent_path().string() + "/none.png cannot be read"));
}

// A disc of 40 cm, 2 cm above the ground, as the chassis of many small robots. A capsule would reach 20 cm below it.
TEST(RobotModel, SquatCylindersAreCylindersAndSlenderOnesCapsules) {
  std::string urdf = test::differential_urdf().text();
  const std::string box = "<collision><geometry><box";
  ASSERT_NE(urdf.find(box), std::string::npos) << urdf;
  urdf.insert(urdf.find(box),
              "<collision><origin xyz='0 0 -0.13'/><geometry><cylinder radius='0.2' length='0.1'/>"
              "</geometry></collision><collision><origin xyz='0 0 0.5'/><geometry>"
              "<cylinder radius='0.02' length='0.4'/></geometry></collision>");
  const test::TemporaryFile world("world.xml", make_flat_world()), robot("robot.urdf", urdf);
  const AssembledModel assembled =
      assemble_model(world.path(), robot.path(), io::load_robot_description(robot.path()), {});
  const mjModel& model = *assembled.physics;
  std::vector<int> types;
  for (int geom = 0; geom < model.ngeom; ++geom)
    if (model.geom_bodyid[geom] == mj_name2id(&model, mjOBJ_BODY, frame_id::kBody))
      types.push_back(model.geom_type[geom]);
  EXPECT_EQ(types, (std::vector<int>{mjGEOM_CYLINDER, mjGEOM_CAPSULE, mjGEOM_BOX}));
}

TEST_F(StreetAssembly, StartHeightIsThatOfTheBody) {
  EXPECT_EQ(start_height_m(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart),
            street().start_qpos[2]);
}

TEST_F(StreetAssembly, EachLinksMassIsThatOfTheUrdfAndTheRobotWeighs12To17Kilograms) {
  const std::string urdf = read(kRobotUrdf);
  const std::regex link("<link name=\"([^\"]+)\">\\s*<inertial>[^]*?<mass value=\"([^\"]+)\"");
  double sum = 0.0;
  int links = 0;
  for (std::sregex_iterator match(urdf.begin(), urdf.end(), link), end; match != end; ++match, ++links) {
    const int body = mj_name2id(street().physics.get(), mjOBJ_BODY, (*match)[1].str().c_str());
    ASSERT_GE(body, 0) << (*match)[1];
    const double mass = std::stod((*match)[2]);
    EXPECT_NEAR(street().physics->body_mass[body], mass, 1e-9) << (*match)[1];
    EXPECT_NEAR(street().view->body_mass[body], mass, 1e-9) << (*match)[1];
    sum += mass;
  }
  EXPECT_GE(links, 13);
  const int base = mj_name2id(street().physics.get(), mjOBJ_BODY, frame_id::kBody);
  EXPECT_NEAR(street().physics->body_subtreemass[base], sum, 1e-9);
  EXPECT_GT(sum, 12.0);
  EXPECT_LT(sum, 17.0);
}

TEST_F(StreetAssembly, PhysicsAndViewHaveTheSameBodiesJointsAndMocapBodiesInTheSameOrder) {
  const mjModel &physics = *street().physics, &view = *street().view;
  ASSERT_EQ(physics.nq, view.nq);
  ASSERT_EQ(physics.nv, view.nv);
  ASSERT_EQ(physics.nu, view.nu);
  ASSERT_EQ(physics.njnt, view.njnt);
  ASSERT_EQ(physics.nmocap, view.nmocap);
  ASSERT_GE(physics.nbody, view.nbody);  // physics may have bodies of its own after those
  for (int joint = 0; joint < view.njnt; ++joint) {
    EXPECT_STREQ(mj_id2name(&physics, mjOBJ_JOINT, joint), mj_id2name(&view, mjOBJ_JOINT, joint));
    EXPECT_EQ(physics.jnt_qposadr[joint], view.jnt_qposadr[joint]);
  }
  for (int body = 0; body < view.nbody; ++body) {
    EXPECT_STREQ(mj_id2name(&physics, mjOBJ_BODY, body), mj_id2name(&view, mjOBJ_BODY, body));
    EXPECT_EQ(physics.body_mocapid[body], view.body_mocapid[body]);
    EXPECT_EQ(physics.body_weldid[body], view.body_weldid[body]);
  }
}

TEST_F(StreetAssembly, PhysicsHasOnlyWhatCanTouchAndTheViewHasEverything) {
  const mjModel& physics = *street().physics;
  for (int geom = 0; geom < physics.ngeom; ++geom) {
    EXPECT_TRUE(physics.geom_contype[geom] != 0 || physics.geom_conaffinity[geom] != 0) << geom;
  }
  EXPECT_LT(physics.ngeom, street().view->ngeom / 2);
  int touchable_in_view = 0;
  for (int geom = 0; geom < street().view->ngeom; ++geom) {
    touchable_in_view += street().view->geom_contype[geom] != 0 || street().view->geom_conaffinity[geom] != 0;
  }
  EXPECT_EQ(physics.ngeom, touchable_in_view);
}

TEST_F(StreetAssembly, StripsNoMassFromActorsAndNoFrictionFromTheGround) {
  const mjModel &physics = *street().physics, &view = *street().view;
  for (int geom = 0; geom < physics.ngeom; ++geom) {
    const char* name = mj_id2name(&physics, mjOBJ_GEOM, geom);
    if (name == nullptr || *name == '\0') continue;
    const int view_geom = mj_name2id(&view, mjOBJ_GEOM, name);
    ASSERT_GE(view_geom, 0) << name;
    EXPECT_EQ(physics.geom_friction[3 * geom], view.geom_friction[3 * view_geom]) << name;
    EXPECT_EQ(physics.geom_type[geom], view.geom_type[view_geom]) << name;
    EXPECT_EQ(physics.geom_condim[geom], view.geom_condim[view_geom]) << name;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(physics.geom_size[3 * geom + i], view.geom_size[3 * view_geom + i]) << name;
  }
}

TEST(ModelAssembly, TheRobotStartsWithItsFeetWithin1CentimetreOfTheGroundOnThePlaneAndOnAPavement) {
  for (const double height : {0.0, 0.1}) {
    const AssembledModel model = on_plane("<geom type='box' pos='0 0 " + std::to_string(height / 2.0 - 1e-4) +
                                              "' size='2 2 " + std::to_string(height / 2.0 + 1e-4) + "'/>",
                                          {0.2, -0.1, 0.7});
    const DataPtr data = make_data(*model.physics);
    std::copy(model.start_qpos.begin(), model.start_qpos.end(), data->qpos);
    mj_kinematics(model.physics.get(), data.get());
    EXPECT_NEAR(data->qpos[0], 0.2, 1e-9);
    EXPECT_NEAR(data->qpos[1], -0.1, 1e-9);
    EXPECT_NEAR(2.0 * std::atan2(data->qpos[6], data->qpos[3]), 0.7, 1e-9);
    for (const char* foot : {"FL_foot", "FR_foot", "RL_foot", "RR_foot"}) {
      const int geom = mj_name2id(model.physics.get(), mjOBJ_GEOM, foot);
      EXPECT_NEAR(data->geom_xpos[3 * geom + 2] - model.physics->geom_size[3 * geom], height, 0.01) << foot;
    }
  }
}

// A foot may start up to 2 cm deep in the ground, so that a start on slightly uneven ground is at the height below the
// center.
TEST(ModelAssembly, WithASlabBelowTheFrontFeetTheRobotStarts2CentimetersBelowTheSlabsHeight) {
  const double on_plane_m = on_plane("").start_qpos[2];
  for (const auto& [slab_m, raised_m] : {std::pair{0.01, 0.0}, {0.08, 0.06}}) {
    const AssembledModel model =
        on_plane(fmt::format("<geom type='box' pos='0.3 0 {0}' size='0.2 1 {0}'/>", slab_m / 2.0));
    EXPECT_NEAR(model.start_qpos[2] - on_plane_m, raised_m, 1e-6) << slab_m;
  }
}

TEST_F(StreetAssembly, EachJointHasAMotorLimitedToTheUrdfsTorque) {
  const RobotDescription robot = io::load_robot_description(kRobotUrdf);
  const mjModel& model = *street().physics;
  ASSERT_EQ(model.nu, 12);
  for (const std::string& joint : robot.joint_names) {
    const int motor = mj_name2id(&model, mjOBJ_ACTUATOR, joint.c_str());
    ASSERT_GE(motor, 0) << joint;
    EXPECT_TRUE(model.actuator_ctrllimited[motor]);
    const double limit_nm = joint.find("knee") != std::string::npos ? 35.55 : 23.7;
    EXPECT_NEAR(model.actuator_ctrlrange[2 * motor + 1], limit_nm, 1e-9) << joint;
    EXPECT_NEAR(model.actuator_ctrlrange[2 * motor], -limit_nm, 1e-9) << joint;
  }
}

AssembledModel tracked_on(const std::string& world, const Pose2& T_world_start = {}) {
  const test::TemporaryFile file("world.xml", world);
  return assemble_model(file.path(), kTrackedUrdf, io::load_robot_description(kTrackedUrdf), T_world_start);
}

TEST(ModelAssembly, TheTrackedRobotWeighsItsUrdfs85KilogramsWithItsWheelsTakenOffTheTracks) {
  const AssembledModel model = tracked_on(make_flat_world());
  const int base = mj_name2id(model.physics.get(), mjOBJ_BODY, frame_id::kBody);
  EXPECT_NEAR(model.physics->body_subtreemass[base], io::load_robot_description(kTrackedUrdf).mass_kg, 1e-9);
}

TEST(ModelAssembly, AFixedLinkWithACollisionShapeButNoInertialHasNoMass) {
  std::string urdf = read(kRobotUrdf);
  const std::string crate =
      R"(<link name="crate"><visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual>
         <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
         <joint name="crate_joint" type="fixed"><parent link="base_link"/><child link="crate"/><origin xyz="0 0 0.2"/></joint>)";
  urdf.insert(urdf.rfind("</robot>"), crate);
  const test::TemporaryFile world("world.xml", make_flat_world()), robot("robot.urdf", urdf);
  const RobotDescription description = io::load_robot_description(robot.path());
  const AssembledModel model = assemble_model(world.path(), robot.path(), description, {});
  const int base = mj_name2id(model.physics.get(), mjOBJ_BODY, frame_id::kBody);
  EXPECT_NEAR(model.physics->body_subtreemass[base], description.mass_kg, 1e-9);
}

TEST(ModelAssembly, TracksWithTheirRoadWheelsHaveTheCenterOfMassOfTheUrdfWithin1Micrometer) {
  const AssembledModel model = tracked_on(make_flat_world());
  const mjModel& physics = *model.physics;
  for (const std::string track : {"left_track", "right_track"}) {
    const int body = mj_name2id(&physics, mjOBJ_BODY, track.c_str());
    double mass_kg = physics.body_mass[body];
    Eigen::Vector3d moment = mass_kg * Eigen::Map<const Eigen::Vector3d>(physics.body_ipos + 3 * body);
    for (int wheel = body + 1; wheel < physics.nbody && physics.body_parentid[wheel] == body; ++wheel) {
      const Eigen::Map<const Eigen::Vector3d> p_wheel(physics.body_pos + 3 * wheel);
      EXPECT_EQ(Eigen::Map<const Eigen::Vector3d>(physics.body_ipos + 3 * wheel).norm(), 0.0) << "of a wheel";
      mass_kg += physics.body_mass[wheel];
      moment += physics.body_mass[wheel] * p_wheel;
    }
    EXPECT_NEAR(mass_kg, 17.0, 1e-9);
    EXPECT_LT((moment / mass_kg - Eigen::Vector3d(0.0, 0.0, -0.045)).norm(), 1e-6);
  }
}

TEST(ModelAssembly, TheTrackedRobotStartsAHandsBreadthAboveRubbleAndAboveAKerbUnderOneTrack) {
  for (const std::string& world :
       {make_rubble_world(4.0, 4.0), make_flat_world(R"(<geom type="box" pos="0 0.3 0.06" size="1 0.1 0.06"/>)")}) {
    const AssembledModel model = tracked_on(world, {0.1, 0.0, 0.0});
    const DataPtr data = make_data(*model.physics);
    std::copy(model.start_qpos.begin(), model.start_qpos.end(), data->qpos);
    mj_forward(model.physics.get(), data.get());
    EXPECT_EQ(data->ncon, 0);
    EXPECT_LT(data->qpos[2], 0.15 + 0.04 + 0.121);  // stands 0.15 m high, 0.04 m above the highest ground
  }
}

TEST(ModelAssembly, PropsAreThereToBeTouchedAndSeen) {
  const test::TemporaryFile file("world.xml", make_flat_world());
  const AssembledModel model =
      assemble_model(file.path(), kTrackedUrdf, io::load_robot_description(kTrackedUrdf), {},
                     {StaticObstacleSettings{.kind = "kerb", .x_m = 2.0, .y_m = 0.0, .yaw_deg = 0.0}});
  EXPECT_GE(mj_name2id(model.physics.get(), mjOBJ_GEOM, "static_obstacle_1"), 0);
  EXPECT_GE(mj_name2id(model.view.get(), mjOBJ_GEOM, "static_obstacle_1"), 0);
}

TEST(ModelAssembly, AStartInsideAWallIsRefusedWithTheWallsName) {
  const std::string said = error_text([] {
    on_plane(R"(<geom name="garden_wall" type="box" pos="1 0 0.5" size="0.2 3 0.5"/>)", {1.0, 0.0, 0.0});
  });
  EXPECT_THAT(said, HasSubstr("start pose (1.00, 0.00)"));
  EXPECT_THAT(said, HasSubstr("garden_wall"));
}

/// Start height of the tracked robot above a floor.
double tracked_start_m(const std::string& geoms, const Pose2& T_world_start) {
  const test::TemporaryFile world("world.xml", make_world(geoms));
  return start_height_m(world.path(), kTrackedUrdf, io::load_robot_description(kTrackedUrdf), T_world_start);
}

TEST(ModelAssembly, RobotsStartOnFloorsFrom20mBelowTo200mAboveTheOriginAndNotOnTheRoof3mHigher) {
  const auto hall = [](double z_m) {
    return fmt::format(
        R"(<geom type="box" pos="0 0 {}" size="9 9 0.1"/><geom type="box" pos="0 0 {}" size="9 9 0.1"/>)", z_m - 0.1,
        z_m + 3.1);
  };
  const double stand_m = tracked_start_m(hall(0.0), {});
  for (const double z_m : {-20.0, -0.5, 1.5, 2.0, 20.0, 200.0}) {
    EXPECT_NEAR(tracked_start_m(hall(z_m), {}), z_m + stand_m, 1e-9) << z_m;
    const test::TemporaryFile world("world.xml", make_world(hall(z_m)));
    EXPECT_NEAR(start_height_m(world.path(), kRobotUrdf, io::load_robot_description(kRobotUrdf), {}), z_m + 0.38, 0.1);
  }
}

TEST(ModelAssembly, AStartOnAHillOf5mIsOnItsSurface) {
  const std::string hill = R"(<geom type="box" pos="0 0 0" size="9 9 5" euler="0 20 0"/>)";
  EXPECT_NEAR(tracked_start_m(hill, {}), 5.0 / std::cos(to_rad(20.0)) + 0.25, 0.25);
}

TEST(ModelAssembly, AStartInsideAWallOf2mOnASlabAt20mIsRefused) {
  const test::TemporaryFile world("world.xml", make_world(R"(<geom type="box" pos="0 0 19.9" size="9 9 0.1"/>
      <geom name="garden_wall" type="box" pos="1 0 21" size="0.2 3 1"/>)"));
  EXPECT_THAT(error_text([&] {
                assemble_model(world.path(), kTrackedUrdf, io::load_robot_description(kTrackedUrdf), {1.0, 0.0, 0.0});
              }),
              HasSubstr("garden_wall"));
}

TEST(ModelAssembly, AStartOverNothingIsRefused) {
  const test::TemporaryFile world("world.xml", make_world(R"(<geom type="box" pos="0 0 -0.1" size="1 1 0.1"/>)"));
  EXPECT_THAT(error_text([&] {
                assemble_model(world.path(), kRobotUrdf, io::load_robot_description(kRobotUrdf), {20.0, 0.0, 0.0});
              }),
              HasSubstr("no ground"));
}

TEST(ModelAssembly, AMissingOrBrokenFileIsRefusedByName) {
  EXPECT_THAT(
      error_text([] { assemble_model("no/such/world.xml", kRobotUrdf, io::load_robot_description(kRobotUrdf), {}); }),
      HasSubstr("no/such/world.xml"));
  const test::TemporaryFile broken("broken.xml", "<mujoco><worldbody><geom tipe=\"box\"/></worldbody></mujoco>");
  EXPECT_THAT(
      error_text([&] { assemble_model(broken.path(), kRobotUrdf, io::load_robot_description(kRobotUrdf), {}); }),
      HasSubstr("broken.xml"));
  const test::TemporaryFile world("world.xml", make_flat_world());
  EXPECT_THAT(error_text([&] {
                assemble_model(world.path(), "no/such/robot.urdf", io::load_robot_description(kRobotUrdf), {});
              }),
              HasSubstr("no/such/robot.urdf"));
}

/// Friction of the first joint of a quadruped of 20 kg with legs of 0.45 m, whose motors have the given torque.
double leg_friction_nm(double effort_nm) {
  const test::TemporaryFile world("world.xml", make_flat_world());
  const test::TemporaryFile urdf("robot.urdf", test::UrdfQuadruped{.effort_nm = effort_nm}.text());
  const AssembledModel model =
      assemble_model(world.path(), urdf.path(), io::load_robot_description(urdf.path()), Pose2{});
  return model.physics->dof_frictionloss[6];
}

TEST(LegFriction, IsProportionalToTheTorqueUpTo3TimesThatOfTheWeight) {
  EXPECT_NEAR(leg_friction_nm(23.7), 0.2, 1e-9);
  EXPECT_NEAR(leg_friction_nm(47.4), 0.4, 1e-9);
  const double of_weight = 1.47 * 0.45 / 0.426;  // ratio of the masses, of the legs
  EXPECT_NEAR(leg_friction_nm(1000.0), 3.0 * of_weight * 0.2, 0.02);
}

}  // namespace
}  // namespace patrol::sim::model_assembly_test
