#include "sim/collision_culler.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "io/urdf.h"
#include "tests/sim/rubble.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"

namespace patrol::sim::nearby_scenery_test {
namespace {

using Touch = std::tuple<int, int, double>;  ///< geoms and distance

std::vector<Touch> touches(const mjData& data) {
  std::vector<Touch> all;
  for (int i = 0; i < data.ncon; ++i)
    all.emplace_back(data.contact[i].geom[0], data.contact[i].geom[1], data.contact[i].dist);
  std::sort(all.begin(), all.end());
  return all;
}

TEST(CollisionCuller, At600PlacesOfTheStreetAndAnyPostureTheContactsAreThoseOfTheWholeStreet) {
  const AssembledModel whole =
      assemble_model(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart);
  const AssembledModel spared =
      assemble_model(kStreetXml, kRobotUrdf, io::load_robot_description(kRobotUrdf), kStreetStart);
  const DataPtr a = make_data(*whole.physics), b = make_data(*spared.physics);
  CollisionCuller nearby(*spared.physics);
  const RandomStream random(1, "places");
  std::size_t contacts = 0;
  int with_actors = 0;
  for (std::uint64_t place = 0; place < 600; ++place) {
    std::vector<double> qpos = whole.start_qpos;
    qpos[0] = 60.0 * random.uniform(place, 0);
    qpos[1] = 100.0 * random.uniform(place, 1);
    qpos[2] = 0.1 + 0.4 * random.uniform(place, 2);
    for (std::size_t i = 3; i < 7; ++i) qpos[i] = random.normal(place, i);
    for (std::size_t i = 7; i < qpos.size(); ++i) qpos[i] += 0.5 * random.normal(place, i);
    mju_normalize4(qpos.data() + 3);
    for (mjData* data : {a.get(), b.get()}) {
      std::copy(qpos.begin(), qpos.end(), data->qpos);
      if (place % 4 == 0) std::copy_n(qpos.data(), 2, data->mocap_pos);  // a pedestrian on top of it
    }
    mj_kinematics(spared.physics.get(), b.get());
    nearby.update(*b);
    mj_forward(whole.physics.get(), a.get());
    mj_forward(spared.physics.get(), b.get());
    const std::vector<Touch> expected = touches(*a);
    EXPECT_EQ(touches(*b), expected) << "at (" << qpos[0] << ", " << qpos[1] << ")";
    contacts += expected.size();
    with_actors += place % 4 == 0 && !expected.empty();
  }
  EXPECT_GT(contacts, 1500u);
  EXPECT_GT(with_actors, 50);
}

TEST(CollisionCuller, OnRubbleWithStonesTheTrackedRobotDrivesAsInTheWholeWorldToTheLastBit) {
  const auto drive = [](bool spare) {
    std::string world = make_rubble_world(10.0, 4.0);
    const std::string stone =
        R"(<geom name="ground_stone" type="sphere" size="0.2" pos="0.4 0.25 -0.1" contype="1" conaffinity="2"/>)";
    world.insert(world.find("</worldbody>"), stone);
    TrackedRobot robot(world, {-2.0, 0.0, 0.0}, {}, tracked_description(), 1, spare);
    robot.drive(0.5, 0.0, 6.0);
    return robot.T_world_body();
  };
  const Pose3 spared = drive(true), whole = drive(false);
  EXPECT_EQ(spared.position, whole.position);
  EXPECT_GT(spared.position.x(), 0.5);
}

TEST(CollisionCuller, AWorldOfAPlaneOnlyKeepsItsGround) {
  WalkingRobot robot(make_flat_world());
  EXPECT_LT(robot.stand(0.5).moved.position().norm(), 0.02);
  EXPECT_GE(robot.state().ncon, 3);
}

}  // namespace
}  // namespace patrol::sim::nearby_scenery_test
