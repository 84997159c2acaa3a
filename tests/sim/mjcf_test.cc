// The model that Patrol builds of each robot, compared with what stock MuJoCo reads from its file, and with the drawn
// shapes.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/geometry/convex_polygon.h"
#include "io/urdf.h"
#include "sim/model_assembly.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim::mjcf_test {
namespace {

const std::vector<std::string> kRobots = {"quadruped", "tracked", "wheeled", "cart"};

std::string urdf_of(const std::string& robot) { return PATROL_SOURCE_DIR "/models/" + robot + "/" + robot + ".urdf"; }

TEST(Mjcf, StockMujocoReadsTheFileOfEachRobotWithTheSameCoordinatesBodiesAndMass) {
  for (const std::string& name : kRobots) {
    SCOPED_TRACE(name);
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "robot.xml", mjcf_of(urdf_of(name), io::load_robot_description(urdf_of(name))));
    char error[1000] = "";
    const ModelPtr read(mj_loadXML((folder / "robot.xml").c_str(), nullptr, error, sizeof(error)));
    ASSERT_TRUE(read) << error;
    const test::TemporaryFile world("world.xml", R"(<mujoco><option timestep="0.002"/><worldbody>
        <geom type="plane" size="20 20 0.1" conaffinity="2"/></worldbody></mujoco>)");
    const AssembledModel built =
        assemble_model(world.path(), urdf_of(name), io::load_robot_description(urdf_of(name)), {});
    EXPECT_EQ(read->nq, built.view->nq);
    EXPECT_EQ(read->nv, built.view->nv);
    EXPECT_EQ(read->nu, built.view->nu);
    EXPECT_EQ(read->nbody, built.view->nbody);
    EXPECT_EQ(read->ngeom, built.view->ngeom);
    EXPECT_NEAR(mj_getTotalmass(read.get()), mj_getTotalmass(built.view.get()), 1e-9);
    ASSERT_EQ(read->nbody, built.view->nbody);
    for (int i = 0; i < 3 * read->nbody; ++i) {
      EXPECT_NEAR(read->body_ipos[i], built.view->body_ipos[i], 1e-9) << name_of(*read, mjOBJ_BODY, i / 3);
      EXPECT_NEAR(read->body_inertia[i], built.view->body_inertia[i], 1e-9) << name_of(*read, mjOBJ_BODY, i / 3);
    }
    ASSERT_EQ(read->nkey, 1);
    for (int i = 7; i < read->nq; ++i)
      EXPECT_NEAR(read->key_qpos[i], built.start_qpos[static_cast<std::size_t>(i)], 1e-9);
    EXPECT_NEAR(mj_getTotalmass(read.get()), io::load_robot_description(urdf_of(name)).mass_kg, 1e-6);
  }
}

// The moments of the chassis have A + B = C. With MuJoCo's six digits, 0.123456 + 0.234567 < 0.358024, and 12.3456789
// kg would be 12.3457 kg.
TEST(Mjcf, StockMujocoReadsTheMassAndTheMomentsOfAFlatPlateWithoutLoss) {
  std::string urdf = test::skid_steer_urdf(0.5, 0.6).text();
  const auto replace = [&urdf](const std::string& tag, const std::string& element) {
    const std::size_t at = urdf.find(tag), end = urdf.find("/>", at);
    ASSERT_NE(at, std::string::npos);
    urdf.replace(at, end + 2 - at, element);
  };
  replace("<mass ", R"(<mass value="12.3456789"/>)");
  replace("<inertia ", R"(<inertia ixx="0.1234564" ixy="0" ixz="0" iyy="0.2345674" iyz="0" izz="0.3580238"/>)");
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "plate.urdf", urdf);
  const std::string file = (folder / "plate.urdf").string();
  test::write_bytes(folder / "plate.xml", mjcf_of(file, io::load_robot_description(file)));
  char error[1000] = "";
  const ModelPtr read(mj_loadXML((folder / "plate.xml").c_str(), nullptr, error, sizeof(error)));
  ASSERT_TRUE(read) << error;
  const int base = mj_name2id(read.get(), mjOBJ_BODY, "base_link");
  std::vector<double> moments(read->body_inertia + 3 * base, read->body_inertia + 3 * base + 3);
  std::sort(moments.begin(), moments.end());
  EXPECT_NEAR(moments[0], 0.1234564, 1e-12);
  EXPECT_NEAR(moments[1], 0.2345674, 1e-12);
  EXPECT_NEAR(moments[2], 0.3580238, 1e-12);
  EXPECT_NEAR(read->body_mass[base], 12.3456789, 1e-12);
}

/// Points on the edges of a geom, seen from above, in the frame of the base.
std::vector<Eigen::Vector2d> outline_of(const mjModel& model, const mjData& data, int geom, int base) {
  std::vector<Eigen::Vector3d> local;
  const mjtNum* size = model.geom_size + 3 * geom;
  const auto add_ring = [&](double radius_m, double z_m) {
    for (int i = 0; i < 64; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 64.0;
      local.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), z_m);
    }
  };
  switch (model.geom_type[geom]) {
    case mjGEOM_BOX:
      for (int corner = 0; corner < 8; ++corner)
        local.emplace_back(corner & 1 ? size[0] : -size[0], corner & 2 ? size[1] : -size[1],
                           corner & 4 ? size[2] : -size[2]);
      break;
    case mjGEOM_CYLINDER:
      for (const double z_m : {-size[1], size[1]}) add_ring(size[0], z_m);
      break;
    default:  // a sphere
      for (int i = -16; i <= 16; ++i) {
        const double tilt = std::numbers::pi / 2.0 * i / 16.0;
        add_ring(size[0] * std::cos(tilt), size[0] * std::sin(tilt));
      }
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_world_geom(data.geom_xmat + 9 * geom),
      R_world_base(data.xmat + 9 * base);
  const Eigen::Map<const Eigen::Vector3d> p_geom(data.geom_xpos + 3 * geom), p_base(data.xpos + 3 * base);
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector3d& point : local)
    outline.push_back((R_world_base.transpose() * (p_geom + R_world_geom * point - p_base)).head<2>());
  return outline;
}

/// Convex hull of the drawn shapes in the start posture.
std::vector<Eigen::Vector2d> drawn_outline(const std::string& robot) {
  const test::TemporaryFile world("world.xml", R"(<mujoco><option timestep="0.002"/><worldbody>
      <geom type="plane" size="20 20 0.1" conaffinity="2"/></worldbody></mujoco>)");
  const AssembledModel built =
      assemble_model(world.path(), urdf_of(robot), io::load_robot_description(urdf_of(robot)), {});
  const DataPtr data = make_data(*built.view);
  std::copy(built.start_qpos.begin(), built.start_qpos.end(), data->qpos);
  mj_kinematics(built.view.get(), data.get());
  const int base = mj_name2id(built.view.get(), mjOBJ_BODY, "base_link");
  std::vector<Eigen::Vector2d> points;
  for (int geom = 0; geom < built.view->ngeom; ++geom) {
    if (built.view->geom_group[geom] != kGroupRobotVisual) continue;
    const std::vector<Eigen::Vector2d> one = outline_of(*built.view, *data, geom, base);
    points.insert(points.end(), one.begin(), one.end());
  }
  return convex_hull(points);
}

/// Difference of the extents of two convex outlines along a direction; its maximum is their Hausdorff distance.
double extent_difference_m(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b,
                           double angle_rad) {
  const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
  const auto extent_m = [&](const std::vector<Eigen::Vector2d>& outline) {
    double extent = -1e9;
    for (const Eigen::Vector2d& corner : outline) extent = std::max(extent, corner.dot(direction));
    return extent;
  };
  return extent_m(a) - extent_m(b);
}

/// Largest distances of the drawn outline outside of the footprint, and of the footprint outside of the drawn outline.
struct Excess {
  double drawn_m = 0.0;
  double footprint_m = 0.0;
};

Excess excess_of(const std::string& robot) {
  const std::vector<Eigen::Vector2d> footprint = io::load_robot_description(urdf_of(robot)).footprint_m,
                                     drawn = drawn_outline(robot);
  Excess excess;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double difference_m = extent_difference_m(drawn, footprint, kDegree * degrees);
    excess.drawn_m = std::max(excess.drawn_m, difference_m);
    excess.footprint_m = std::max(excess.footprint_m, -difference_m);
  }
  return excess;
}

TEST(Footprint, OfRobotsOnTracksAndWheelsIsWithinTwoCentimetersOfTheOutlineOfTheDrawnShapes) {
  for (const char* robot : {"tracked", "wheeled", "cart"}) {
    const Excess excess = excess_of(robot);
    EXPECT_LE(excess.drawn_m, 0.02) << robot;
    EXPECT_LE(excess.footprint_m, 0.02) << robot;
  }
}

/// Thighs and shanks do not count (io/urdf_legs.cc): the rear knees are behind the footprint.
TEST(Footprint, OfTheQuadrupedLeavesOutTheKneesSixteenCentimetersBehindIt) {
  const Excess excess = excess_of("quadruped");
  EXPECT_NEAR(excess.drawn_m, 0.158, 0.003);
  EXPECT_LE(excess.footprint_m, 0.02);
}

}  // namespace
}  // namespace patrol::sim::mjcf_test
