#include "sim/sensors/hall_sensors.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/mujoco.h"

namespace patrol::sim::hall_sensors_test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kTicksPerTurn = 720;  // 24 a motor turn through a gear of 30

/// Two free wheels.
class TwoSprockets : public testing::Test {
 protected:
  TwoSprockets()
      : model_(compile(*parse_spec(R"(<mujoco><worldbody>
          <body><joint name="left" axis="0 1 0"/><geom size="0.1"/></body>
          <body><joint name="right" axis="0 1 0"/><geom size="0.1"/></body></worldbody></mujoco>)"),
                       "two sprockets")),
        data_(make_data(*model_)) {}

  HallSensors sensors(const HallSettings& settings = {}, std::uint64_t seed = 1) const {
    return HallSensors(settings, *model_, {"left", "right"}, seed);
  }
  TrackTicks read_at(HallSensors& hall, double left_rad, double right_rad) {
    data_->qpos[0] = left_rad;
    data_->qpos[1] = right_rad;
    return hall.read(*data_, Time{});
  }

  ModelPtr model_;
  DataPtr data_;
};

TEST_F(TwoSprockets, OneTurnForwardsIs720TicksAndOneBackwardsTakesThemAway) {
  HallSensors hall = sensors();
  const TrackTicks turned = read_at(hall, kTurn + 1e-6, -kTurn - 1e-6);
  EXPECT_EQ(turned.left, kTicksPerTurn);
  EXPECT_EQ(turned.right, -kTicksPerTurn - 1);  // the edge at zero counts too
  const TrackTicks back = read_at(hall, 1e-6, -1e-6);
  EXPECT_EQ(back.left, 0);
  EXPECT_EQ(back.right, -1);
}

TEST_F(TwoSprockets, NothingIsCountedWithinATick) {
  HallSensors hall = sensors();
  EXPECT_EQ(read_at(hall, 0.99 * kTurn / kTicksPerTurn, 0.0).left, 0);
  EXPECT_EQ(read_at(hall, 1.01 * kTurn / kTicksPerTurn, 0.0).left, 1);
}

TEST_F(TwoSprockets, TenPercentOfTheEdgesOf100TurnsAreMissedToWithinFourStandardErrors) {
  HallSettings settings;
  settings.missed_edge_probability = 0.1;
  HallSensors hall = sensors(settings);
  constexpr int kEdges = 100 * kTicksPerTurn;
  const double counted = static_cast<double>(read_at(hall, 100.0 * kTurn + 1e-6, 0.0).left);
  const double bound = 4.0 * std::sqrt(0.1 * 0.9 * kEdges);  // four standard errors of a binomial count
  EXPECT_NEAR(counted, 0.9 * kEdges, bound);
  EXPECT_EQ(read_at(hall, 100.0 * kTurn + 1e-6, 0.0).left, static_cast<std::int64_t>(counted)) << "missed for good";
}

TEST_F(TwoSprockets, TheSidesMissTheirOwnEdgesAndTheSameSeedTheSame) {
  HallSettings settings;
  settings.missed_edge_probability = 0.1;
  HallSensors first = sensors(settings), again = sensors(settings), other = sensors(settings, 2);
  const TrackTicks a = read_at(first, 50.0, 50.0), b = read_at(again, 50.0, 50.0), c = read_at(other, 50.0, 50.0);
  EXPECT_NE(a.left, a.right);
  EXPECT_EQ(a.left, b.left);
  EXPECT_EQ(a.right, b.right);
  EXPECT_NE(a.left, c.left);
}

TEST_F(TwoSprockets, AWrongSettingOrAMissingJointIsNamed) {
  HallSettings settings;
  settings.missed_edge_probability = 1.5;
  EXPECT_THAT([&] { sensors(settings); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("sensors.hall.missed_edge_probability = 1.5")));
  EXPECT_THAT(
      [&] {
        HallSensors({}, *model_, {"left", "starboard"}, 1);
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr("starboard")));
}

}  // namespace
}  // namespace patrol::sim::hall_sensors_test
