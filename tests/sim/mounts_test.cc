// The twin and the description of a robot have the same sensor frames.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "sim/model_assembly.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::mounts_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<std::string> kRobots = {"quadruped", "tracked", "wheeled", "cart"};

std::string urdf_of(const std::string& robot) { return PATROL_SOURCE_DIR "/models/" + robot + "/" + robot + ".urdf"; }

io::SensorMount mount(const std::string& frame, const Eigen::Vector3d& position_m, const Eigen::Vector3d& rpy_deg,
                      const std::string& parent = "base_link") {
  return {.frame = frame,
          .parent = parent,
          .position_m = position_m,
          .rpy_rad = kDegree * rpy_deg,
          .location = "robot.yaml:3: mounts.0"};
}

/// Pose of a site of the twin in its base, with the robot away from the origin of the world.
Pose3 site_in_base(const mjModel& model, const std::string& frame) {
  const DataPtr data = make_data(model);
  data->qpos[0] = 3.0;
  data->qpos[1] = -2.0;
  mj_kinematics(&model, data.get());
  const int site = mj_name2id(&model, mjOBJ_SITE, frame.c_str()), base = mj_name2id(&model, mjOBJ_BODY, "base_link");
  if (site < 0) throw InputError("no site " + frame);
  Eigen::Matrix3d R_world_site = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->site_xmat + 9 * site);
  const Pose3 T_world_site{Eigen::Vector3d(data->site_xpos + 3 * site), Eigen::Quaterniond(R_world_site)};
  const mjtNum* q = data->xquat + 4 * base;
  const Pose3 T_world_base{Eigen::Vector3d(data->xpos + 3 * base), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
  return T_world_base.inverse() * T_world_site;
}

const std::string kFlat = R"(<mujoco><option timestep="0.002"/><worldbody>
    <geom type="plane" size="20 20 0.1" conaffinity="2"/></worldbody></mujoco>)";

AssembledModel on_plane(const std::string& urdf, const io::MountedRobot& robot) {
  const test::TemporaryFile world("world.xml", kFlat);
  return assemble_model(world.path(), {urdf, robot.urdf}, robot.description, {});
}

void expect_same_frames(const io::MountedRobot& robot, const mjModel& model, const std::vector<std::string>& frames) {
  for (const std::string& frame : frames) {
    const Pose3 twin = site_in_base(model, frame);
    const Pose3& described = robot.description.T_body(frame);
    EXPECT_LT((twin.position - described.position).norm(), 1e-9) << frame;
    EXPECT_LT(twin.rotation.angularDistance(described.rotation), 1e-7) << frame;
    EXPECT_LT((twin.rotation.toRotationMatrix() - described.rotation.toRotationMatrix()).norm(), 1e-9) << frame;
  }
}

TEST(Mounts, AMovedAndAnAddedFrameAreTheSameInTheTwinAndTheDescriptionOfEveryRobotToOneNanometer) {
  for (const std::string& name : kRobots) {
    SCOPED_TRACE(name);
    const Eigen::Vector3d p_m(0.31, -0.07, 0.52), rpy_deg(3.0, -90.0, 170.0);
    const io::MountedRobot robot =
        io::load_mounted_robot(urdf_of(name), {mount("lidar", p_m, rpy_deg), mount("imu", {0.1, 0.2, 0.05}, {0, 0, 90}),
                                               mount("lidar_rear", {-0.4, 0.1, 0.3}, {0, 0, 180}),
                                               mount("depth_camera", {0.02, 0, 0.1}, {0, 20, 0}, "lidar")});
    EXPECT_EQ(robot.description.T_body("lidar").position, p_m);
    const AssembledModel model = on_plane(urdf_of(name), robot);
    expect_same_frames(robot, *model.physics, {"lidar", "imu", "lidar_rear", "depth_camera"});
    expect_same_frames(robot, *model.view, {"lidar", "imu", "lidar_rear", "depth_camera"});
  }
}

TEST(Mounts, AMountOnTheMastIsRelativeToTheMast) {
  const io::MountedRobot robot =
      io::load_mounted_robot(urdf_of("wheeled"), {mount("lidar_rear", {-0.05, 0.0, 0.1}, {0, 0, 180}, "mast")});
  EXPECT_LT((robot.description.T_body("lidar_rear").position - Eigen::Vector3d(0.05, 0.0, 0.34)).norm(), 1e-12);
  expect_same_frames(robot, *on_plane(urdf_of("wheeled"), robot).physics, {"lidar_rear"});
}

TEST(Mounts, AMountAddsNeitherMassNorJointsAndWithoutMountsTheTextIsThatOfTheFile) {
  for (const std::string& name : kRobots) {
    const io::MountedRobot plain = io::load_mounted_robot(urdf_of(name), {});
    const io::MountedRobot robot =
        io::load_mounted_robot(urdf_of(name), {mount("lidar_rear", {-0.4, 0.0, 0.3}, {0, 0, 180})});
    EXPECT_EQ(plain.urdf, test::read_bytes(urdf_of(name)));
    EXPECT_EQ(robot.description.mass_kg, plain.description.mass_kg);
    EXPECT_EQ(robot.description.joint_names, plain.description.joint_names);
    EXPECT_EQ(robot.description.T_body_sensor.size(), plain.description.T_body_sensor.size() + 1);
    for (const auto& [frame, T_body_frame] : plain.description.T_body_sensor)
      EXPECT_EQ(robot.description.T_body(frame).position, T_body_frame.position) << name << " " << frame;
    EXPECT_EQ(on_plane(urdf_of(name), robot).physics->nv, on_plane(urdf_of(name), plain).physics->nv) << name;
  }
}

TEST(Mounts, TheHousingOfAMovedLidarMovesWithIt) {
  const io::MountedRobot robot =
      io::load_mounted_robot(urdf_of("wheeled"), {mount("lidar", {-0.2, 0.1, 0.6}, {0, 0, 0})});
  const AssembledModel model = on_plane(urdf_of("wheeled"), robot);
  const int body = mj_name2id(model.view.get(), mjOBJ_BODY, "lidar");
  ASSERT_GE(body, 0);
  EXPECT_EQ(model.view->body_pos[3 * body], -0.2);
  EXPECT_GT(model.view->body_geomnum[body], 0);
}

TEST(Mounts, AParentThatIsUnknownOrMovesAndAFrameBelowItselfAreRefusedAtTheirPlace) {
  const auto load = [](const io::SensorMount& one) {
    return [one] { io::load_mounted_robot(urdf_of("wheeled"), {one}); };
  };
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_THAT(load(mount("lidar_rear", zero, zero, "masst")),
              ThrowsMessage<InputError>(AllOf(HasSubstr("robot.yaml:3: mounts.0.parent = masst: unknown link"),
                                              HasSubstr("must be one of base_link, "), HasSubstr("mast"))));
  EXPECT_THAT(load(mount("lidar_rear", zero, zero, "front_left_wheel")),
              ThrowsMessage<InputError>(HasSubstr(
                  "robot.yaml:3: mounts.0.parent = front_left_wheel: not fixed to base_link: must be one of")));
  EXPECT_THAT(load(mount("lidar", zero, zero, "lidar")),
              ThrowsMessage<InputError>(
                  HasSubstr("robot.yaml:3: mounts.0.parent = lidar: is fixed to the frame lidar itself")));
}

}  // namespace
}  // namespace patrol::sim::mounts_test
