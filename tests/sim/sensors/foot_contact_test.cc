#include "sim/sensors/foot_contact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::foot_contact_test {
namespace {

/// A foot of 3 kg that rests on the ground and one that hangs in the air.
const std::string kTwoFeet = R"(<geom type="plane" size="5 5 1"/>
  <body pos="0 0 0.1"><joint type="slide" axis="0 0 1" damping="30"/><geom name="left_foot" size="0.1" mass="3"/></body>
  <body pos="1 0 1"><geom name="right_foot" size="0.1" mass="3"/></body>)";

std::vector<LegGeometry> two_legs() {
  std::vector<LegGeometry> legs(2);
  legs[0].foot_link = "left_foot";
  legs[1].foot_link = "right_foot";
  return legs;
}

FootContactSettings ideal() {
  FootContactSettings settings;
  settings.noise_std_n = settings.offset_std_n = settings.resolution_n = 0.0;
  return settings;
}

struct TwoFeet : SmallWorld {
  TwoFeet() : SmallWorld(kTwoFeet) {
    for (int i = 0; i < 1000; ++i) mj_step(model.get(), data.get());
    mj_forward(model.get(), data.get());
  }
};

TEST(FootContact, AFootOf3KilogramsAtRestReadsItsWeightAndOneInTheAirNothing) {
  const TwoFeet feet;
  const FootContacts contacts =
      FootContactSensor(ideal(), *feet.model, two_legs(), 1).read(*feet.model, *feet.data, Time{}, 0);
  EXPECT_NEAR(contacts.force_n[0], 3.0 * 9.81, 0.01);
  EXPECT_EQ(contacts.force_n[1], 0.0);
}

TEST(FootContact, NoiseIs1NewtonOnEachFootApart) {
  const TwoFeet feet;
  FootContactSettings settings = ideal();
  settings.noise_std_n = 1.0;
  const FootContactSensor sensor(settings, *feet.model, two_legs(), 1);
  test::Moments left, right;
  double together = 0.0;
  for (std::uint64_t tick = 0; tick < 10000; ++tick) {
    const FootContacts contacts = sensor.read(*feet.model, *feet.data, Time{}, tick);
    left.add(contacts.force_n[0] - 3.0 * 9.81);
    right.add(contacts.force_n[1]);
    together += (contacts.force_n[0] - 3.0 * 9.81) * contacts.force_n[1];
  }
  EXPECT_NEAR(left.std(), 1.0, 0.03);
  EXPECT_NEAR(right.std(), 1.0, 0.03);
  EXPECT_NEAR(right.mean(), 0.0, 0.04);
  EXPECT_NEAR(together / 10000.0, 0.0, 0.04);
}

TEST(FootContact, EachFootKeepsAnOffsetOf1NewtonForTheRun) {
  const TwoFeet feet;
  FootContactSettings settings = ideal();
  settings.offset_std_n = 1.0;
  test::Moments offset;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const FootContactSensor sensor(settings, *feet.model, two_legs(), seed);
    const double first = sensor.read(*feet.model, *feet.data, Time{}, 0).force_n[1];
    EXPECT_EQ(sensor.read(*feet.model, *feet.data, Time{}, 1).force_n[1], first);
    offset.add(first);
  }
  EXPECT_NEAR(offset.std(), 1.0, 0.05);
  EXPECT_NEAR(offset.mean(), 0.0, 0.1);
}

TEST(FootContact, ReadsHalfNewtonsAndStopsAtItsRange) {
  const TwoFeet feet;
  const FootContactSensor sensor({}, *feet.model, two_legs(), 1);
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const double twice = 2.0 * sensor.read(*feet.model, *feet.data, Time{}, tick).force_n[0];
    EXPECT_EQ(twice, std::round(twice));
  }
  FootContactSettings narrow = ideal();
  narrow.range_n = 20.0;
  EXPECT_EQ(FootContactSensor(narrow, *feet.model, two_legs(), 1).read(*feet.model, *feet.data, Time{}, 0).force_n[0],
            20.0);
}

TEST(FootContact, SwitchingTheOffsetOffLeavesTheNoiseAsItWas) {
  const TwoFeet feet;
  FootContactSettings noisy = ideal();
  noisy.noise_std_n = 1.0;
  FootContactSettings both = noisy;
  both.offset_std_n = 1.0;
  const FootContactSensor a(both, *feet.model, two_legs(), 9), b(noisy, *feet.model, two_legs(), 9);
  const auto difference = [&](std::uint64_t tick) {
    return a.read(*feet.model, *feet.data, Time{}, tick).force_n[1] -
           b.read(*feet.model, *feet.data, Time{}, tick).force_n[1];
  };
  for (std::uint64_t tick = 1; tick < 50; ++tick) EXPECT_NEAR(difference(tick), difference(0), 1e-12);
}

TEST(FootContact, AModelWithoutTheFootIsRefused) {
  const TwoFeet feet;
  std::vector<LegGeometry> legs = two_legs();
  legs[1].foot_link = "hind";
  EXPECT_THROW(FootContactSensor({}, *feet.model, legs, 1), InputError);
}

}  // namespace
}  // namespace patrol::sim::foot_contact_test
