#include "sim/twin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/urdf.h"
#include "tests/sim/rubble.h"
#include "tests/support/tracked_twin.h"
#include "tests/support/quadruped_twin.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim {
namespace {

/// A twin of a robot in a small world, with no sensor but those that its firmware reads.
class SmallTwin {
 public:
  SmallTwin(const std::string& urdf, const std::string& world) : file_("world.xml", world), twin_(make(urdf)) {}

  Twin& operator*() { return twin_; }
  Twin* operator->() { return &twin_; }

  /// Messages that were delivered meanwhile.
  std::vector<SensorMessage> run(double vx_mps, double duration_s) {
    twin_.set_command({.stamp = {}, .vx_mps = vx_mps, .vy_mps = 0.0, .yaw_rate_radps = 0.0});
    std::vector<SensorMessage> all;
    for (const Time end = twin_.now() + from_seconds(duration_s); twin_.now() < end;) {
      twin_.step();
      for (SensorMessage& message : twin_.take_messages()) all.push_back(std::move(message));
    }
    return all;
  }

 private:
  Twin make(const std::string& urdf) const {
    TwinSettings settings;
    settings.world_xml = file_.path();
    settings.robot_urdf = urdf;
    settings.sensors.lidar.enabled = settings.sensors.tdlas.enabled = settings.sensors.gnss.enabled = false;
    return Twin(settings, io::load_robot_description(urdf), 1);
  }

  test::TemporaryFile file_;
  Twin twin_;
};

template <typename Message>
std::ptrdiff_t count(const std::vector<SensorMessage>& messages) {
  return std::count_if(messages.begin(), messages.end(),
                       [](const SensorMessage& message) { return std::holds_alternative<Message>(message); });
}

TEST(Twin, ATrackedRobotSends50TicksASecondAndNothingOfLegs) {
  SmallTwin twin(kTrackedUrdf, make_flat_world());
  const auto messages = twin.run(0.5, 2.0);
  EXPECT_NEAR(static_cast<double>(count<TrackTicks>(messages)), 100.0, 1.0);
  EXPECT_EQ(count<JointState>(messages), 0);
  EXPECT_EQ(count<FootContacts>(messages), 0);
  EXPECT_GT(count<Imu>(messages), 0);
  EXPECT_NEAR(twin->truth().T_world_body.position.x(), 0.5 * (2.0 - 0.3), 0.1);
}

TEST(Twin, ARobotOnLegsSendsNoTicks) {
  SmallTwin twin(kRobotUrdf, make_flat_world());
  EXPECT_EQ(count<TrackTicks>(twin.run(0.0, 0.2)), 0);
}

TEST(Twin, LiftedToAnotherPlaceEitherRobotStandsThereUprightAndItsCountersKnowNothingOfIt) {
  for (const std::string& urdf : {kTrackedUrdf, kRobotUrdf}) {
    SmallTwin twin(urdf, make_flat_world(R"(<geom name="ground_stage" type="box" pos="6 2 0.1" size="1 1 0.1"/>)"));
    twin.run(0.4, 2.0);
    const SimState before = twin->state();
    twin->put_at({6.0, 2.0, 2.0});
    const SimState after = twin->state();
    if (urdf == kTrackedUrdf) {
      EXPECT_TRUE(std::equal(before.qpos.begin() + 7, before.qpos.end(), after.qpos.begin() + 7)) << "belts and springs";
    }
    const GroundTruth at_once = twin->truth();
    EXPECT_NEAR(at_once.T_world_body.position.x(), 6.0, 1e-9);
    EXPECT_NEAR(yaw_of(at_once.T_world_body.rotation), 2.0, 1e-9);
    EXPECT_EQ(at_once.twist.linear.norm(), 0.0);
    twin.run(0.0, 3.0);
    const Pose3 later = twin->truth().T_world_body;
    EXPECT_LT((later.position - Eigen::Vector3d(6.0, 2.0, later.position.z())).norm(), 0.1) << urdf;
    EXPECT_GT(later.position.z(), 0.2 + 0.1) << "on the stage of 0.2 m";
    EXPECT_FALSE(twin->has_fallen()) << urdf;
  }
}

TEST(Twin, PutDownOnRubbleItDrivesOn) {
  SmallTwin twin(kTrackedUrdf, make_rubble_world(16.0, 6.0));
  twin.run(0.5, 1.0);
  twin->put_at({-6.0, 1.0, 0.0});
  twin.run(0.5, 4.0);
  EXPECT_NEAR(twin->truth().T_world_body.position.x(), -6.0 + 0.5 * 3.7, 0.2);
}

TEST(Twin, WhereThereIsNoGroundItCannotBePut) {
  SmallTwin twin(kTrackedUrdf, make_rubble_world(4.0, 4.0));
  EXPECT_THAT([&] { twin->put_at({50.0, 0.0, 0.0}); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("(50.00, 0.00): there is no ground below it")));
}

}  // namespace
}  // namespace patrol::sim
