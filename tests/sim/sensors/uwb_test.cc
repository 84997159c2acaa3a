#include "sim/sensors/uwb.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::uwb_test {
namespace {

constexpr int kPolls = 20000;

std::string anchor(int number, const std::string& pos) {
  return "<site name=\"uwb_anchor_" + std::to_string(number) + "\" pos=\"" + pos + "\"/>";
}

/// Nothing but what is asked for.
UwbSettings ideal() {
  UwbSettings settings;
  settings.range_max_m = 1000.0;
  settings.range_noise_std_m = settings.bias_scale = settings.loss_probability = settings.nlos_loss_probability =
      settings.nlos_bias_m = 0.0;
  return settings;
}

struct Ranges {
  test::Moments error_m;
  int polls = 0;
  double lost() const { return 1.0 - static_cast<double>(error_m.count) / polls; }
};

/// Polls of a world with one anchor, from the origin 1 m up.
Ranges poll(const SmallWorld& world, const UwbSettings& settings, int polls = kPolls) {
  Uwb uwb(settings, *world.model, 7);
  const Eigen::Vector3d antenna(0, 0, 1);
  const double distance_m = (uwb.anchors().front().p_world - antenna).norm();
  Ranges ranges{.error_m = {}, .polls = polls};
  for (int tick = 0; tick < polls; ++tick) {
    const auto range = uwb.read(world.scene, antenna, Time{}, static_cast<std::uint64_t>(tick));
    if (range) ranges.error_m.add(range->range_m - distance_m);
  }
  return ranges;
}

double share_tolerance(double share, int n) { return 4.0 * std::sqrt(share * (1.0 - share) / n); }

TEST(Uwb, AnIdealRangeIsTheDistanceBetweenAntennaAndAnchor) {
  const SmallWorld world(anchor(4, "3 4 13"));  // 3, 4, 12 from the antenna: 13
  const auto range = Uwb(ideal(), *world.model, 1).read(world.scene, {0, 0, 1}, from_seconds(2.5), 0);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->anchor, 4);
  EXPECT_EQ(range->stamp, from_seconds(2.5));
  EXPECT_NEAR(range->range_m, 13.0, 1e-12);
}

TEST(Uwb, NoiseInSightIs7CentimetresAboutTheTruth) {
  UwbSettings settings = ideal();
  settings.range_noise_std_m = 0.07;
  const Ranges ranges = poll(SmallWorld(anchor(1, "20 0 1")), settings);
  EXPECT_NEAR(ranges.error_m.mean(), 0.0, 4.0 * 0.07 / std::sqrt(kPolls));
  EXPECT_NEAR(ranges.error_m.std(), 0.07, 4.0 * 0.07 / std::sqrt(2.0 * kPolls));
  EXPECT_EQ(ranges.lost(), 0.0);
}

// Free space: level = -14.3 dBm - 20 log10(4 pi d f / c), so d = c / (4 pi f) 10^((-14.3 - level) / 20).
TEST(Uwb, BiasFollowsTable2OfAps011ByTheSignalLevelInFreeSpace) {
  const std::map<double, double> bias_m_by_level_dbm = {
      {-61.0, -0.110}, {-69.0, -0.082}, {-77.0, 0.0}, {-78.0, 0.0105}, {-83.0, 0.042}, {-93.0, 0.081}, {-99.0, 0.081}};
  for (const auto& [level_dbm, bias_m] : bias_m_by_level_dbm) {
    const double distance_m =
        299792458.0 / (4.0 * 3.141592653589793 * 3993.6e6) * std::pow(10.0, (-14.3 - level_dbm) / 20.0);
    UwbSettings settings = ideal();
    settings.bias_scale = 1.0;
    const SmallWorld world(anchor(1, std::to_string(distance_m) + " 0 1"));
    EXPECT_NEAR(poll(world, settings, 1).error_m.mean(), bias_m, 1e-6) << level_dbm << " dBm, " << distance_m << " m";
  }
}

TEST(Uwb, OneIn50CloseByIsLostAndHalfAtFourFifthsOfTheReach) {
  UwbSettings settings = ideal();
  settings.loss_probability = 0.02;
  settings.range_max_m = 60.0;
  const double close_by = 0.02 + 0.98 * std::pow(1.0 / 12.0, 4);  // 5 m
  const double far_away = 0.02 + 0.98 * std::pow(0.8, 4);         // 48 m: 0.42
  EXPECT_NEAR(poll(SmallWorld(anchor(1, "5 0 1")), settings).lost(), close_by, share_tolerance(close_by, kPolls));
  EXPECT_NEAR(poll(SmallWorld(anchor(1, "48 0 1")), settings).lost(), far_away, share_tolerance(far_away, kPolls));
  EXPECT_EQ(poll(SmallWorld(anchor(1, "60.1 0 1")), settings).lost(), 1.0);
}

TEST(Uwb, BehindAWallTheExcessIsExponentialOf40CentimetresAndThreeInTenAreLost) {
  UwbSettings settings = ideal();
  settings.nlos_bias_m = 0.4;
  settings.nlos_loss_probability = 0.3;
  const SmallWorld world(anchor(1, "20 0 1") + R"(<geom type="box" pos="10 0 1" size="0.2 2 2"/>)");
  const Ranges ranges = poll(world, settings);
  EXPECT_NEAR(ranges.lost(), 0.3, share_tolerance(0.3, kPolls));
  const double n = ranges.error_m.count;
  EXPECT_NEAR(ranges.error_m.mean(), 0.4, 4.0 * 0.4 / std::sqrt(n));
  EXPECT_NEAR(ranges.error_m.std(), 0.4, 4.0 * 0.4 * std::sqrt(2.0 / n));  // the variance of s^2 is 8 mean^4 / n
  EXPECT_GE(ranges.error_m.smallest, 0.0);
}

// At 20 m the level is -84.8 dBm, where table 2 of APS011 gives 4.83 cm between its rows of -83 and -85 dBm.
TEST(Uwb, TheDefaultsAreRecoveredFromRangesInAndOffTheLineOfSight) {
  const SmallWorld in_sight(anchor(1, "20 0 1"));
  const Ranges los = poll(in_sight, {});
  const double n = los.error_m.count, lost = 0.02 + 0.98 * std::pow(20.0 / 60.0, 4);
  EXPECT_NEAR(los.lost(), lost, share_tolerance(lost, kPolls));
  EXPECT_NEAR(los.error_m.std(), 0.07, 4.0 * 0.07 / std::sqrt(2.0 * n));
  EXPECT_NEAR(los.error_m.mean(), 0.0483, 4.0 * 0.07 / std::sqrt(n) + 1e-3);

  const SmallWorld blocked(anchor(1, "20 0 1") + R"(<geom type="box" pos="10 0 1" size="0.2 2 2"/>)");
  const Ranges nlos = poll(blocked, {});
  const double m = nlos.error_m.count, nlos_lost = 1.0 - (1.0 - lost) * (1.0 - 0.3);
  EXPECT_NEAR(nlos.lost(), nlos_lost, share_tolerance(nlos_lost, kPolls));
  EXPECT_NEAR(nlos.error_m.mean() - los.error_m.mean(), 0.4, 4.0 * std::hypot(0.4 / std::sqrt(m), 0.07 / std::sqrt(n)));
  EXPECT_NEAR(nlos.error_m.std(), std::hypot(0.4, 0.07), 4.0 * 0.4 * std::sqrt(2.0 / m));

  EXPECT_EQ(poll(SmallWorld(anchor(1, "60.1 0 1")), {}, 1000).lost(), 1.0);
  EXPECT_DOUBLE_EQ(UwbSettings{}.rate_hz, 30.0);
}

bool is_blocked_by(const std::string& geom) {
  const SmallWorld world(geom);
  return is_uwb_path_nlos(world.scene, {0, 0, 1}, {20, 0, 1});
}

TEST(Uwb, AManOrAPillarBlocksThePathAndACableDoesNot) {
  EXPECT_TRUE(is_blocked_by(R"(<geom type="capsule" pos="10 0 0.9" size="0.2 0.7"/>)"));
  EXPECT_TRUE(is_blocked_by(R"(<geom type="cylinder" pos="3 0 1" size="0.15 2"/>)"));
  EXPECT_FALSE(is_blocked_by(R"(<geom type="cylinder" pos="10 0 1" size="0.01 2"/>)"));
  EXPECT_FALSE(is_blocked_by(R"(<geom type="cylinder" pos="10 0 1" euler="90 0 0" size="0.01 2"/>)"));
  EXPECT_FALSE(is_blocked_by(R"(<geom type="box" pos="10 0 0" size="10 5 0.8"/>)"));  // 20 cm below
}

TEST(Uwb, TheWallBehindTheAnchorAndTheHousingsDoNotBlock) {
  EXPECT_FALSE(is_blocked_by(R"(<geom type="box" pos="20.55 0 1" size="0.5 5 5"/>
      <geom type="box" pos="20 0 1" size="0.04 0.04 0.04"/><geom type="sphere" pos="0 0 1" size="0.04"/>)"));
}

TEST(Uwb, TheRobotsOwnMastBlocks) {
  EXPECT_TRUE(is_blocked_by(
      R"(<body name="base_link"><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
      <geom type="box" pos="0.3 0 1" size="0.05 0.1 0.2" group="4" contype="0" conaffinity="0"/></body>)"));
}

TEST(Uwb, AnchorsInReachTakeTurnsByNumber) {
  const SmallWorld world(anchor(12, "30 0 1") + anchor(2, "5 0 1") + anchor(7, "90 0 1") + anchor(3, "0 9 1") +
                         R"(<site name="uwb_anchor_x" pos="1 0 1"/><site name="charger" pos="1 0 1"/>)");
  UwbSettings settings = ideal();
  settings.range_max_m = 60.0;
  Uwb uwb(settings, *world.model, 1);
  EXPECT_EQ(uwb.anchors().size(), 4u);
  std::vector<int> asked;
  for (std::uint64_t tick = 0; asked.size() < 6; ++tick) {
    if (const auto range = uwb.read(world.scene, {0, 0, 1}, Time{}, tick)) asked.push_back(range->anchor);
  }
  EXPECT_EQ(asked, (std::vector{2, 3, 12, 2, 3, 12}));
}

TEST(Uwb, WithoutNoiseBiasAndExcessTheSamePollsAreLost) {
  const SmallWorld world(anchor(1, "20 0 1") + R"(<geom type="box" pos="10 0 1" size="0.2 2 2"/>)");
  UwbSettings quiet;
  quiet.range_noise_std_m = quiet.bias_scale = quiet.nlos_bias_m = 0.0;
  Uwb a({}, *world.model, 3), b(quiet, *world.model, 3);
  int lost = 0;
  for (std::uint64_t tick = 0; tick < 500; ++tick) {
    const auto noisy = a.read(world.scene, {0, 0, 1}, Time{}, tick),
               bare = b.read(world.scene, {0, 0, 1}, Time{}, tick);
    EXPECT_EQ(noisy.has_value(), bare.has_value());
    lost += !noisy.has_value();
  }
  EXPECT_GT(lost, 100);
}

TEST(Uwb, AWorldWithoutAnchorsIsRefusedInASentence) {
  const SmallWorld world(R"(<geom size="1"/>)");
  try {
    Uwb uwb({}, *world.model, 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "sensors.uwb.enabled = true: requires a world site named uwb_anchor_<number>");
  }
}

}  // namespace
}  // namespace patrol::sim::uwb_test
