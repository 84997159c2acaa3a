#include "sim/sensors/ultrasonic.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::ultrasonic_test {
namespace {

constexpr float kSilence = std::numeric_limits<float>::infinity();
constexpr int kPings = 2000;

/// Transducers at (0, y) that look ahead, turned by `yaw_deg` each.
RobotDescription make_ring(const std::vector<double>& y_m = {0.0}, const std::vector<double>& yaw_deg = {0.0}) {
  RobotDescription robot;
  robot.name = "carrier";
  for (std::size_t i = 0; i < y_m.size(); ++i) {
    robot.T_body_sensor[fmt::format("ultrasonic_{}", i)] = {{0.0, y_m[i], 0.0},
                                                            quaternion_from_yaw(kDegree * yaw_deg[i])};
  }
  return robot;
}

UltrasonicSettings ideal() {
  UltrasonicSettings settings;
  settings.range_noise_std_m = settings.range_quantization_m = settings.dropout_probability = 0.0;
  settings.air_temperature_c = settings.assumed_temperature_c;
  return settings;
}

/// A thin wall whose middle is `distance_m` ahead of the ring, 0.3 m up, turned away by `yaw_deg`.
std::string wall(double distance_m, double yaw_deg = 0.0, const char* name = "wall") {
  return fmt::format(R"(<geom name="{}" type="box" pos="{} 0 0.3" euler="0 0 {}" size="1e-6 3 3"/>)", name, distance_m,
                     yaw_deg);
}

struct Heard {
  test::Moments range_m;
  int pings = 0, silent = 0, too_close = 0;
  double share_silent() const { return static_cast<double>(silent) / pings; }
};

/// Readings of transducer `which`, 0.3 m up at the origin, `step_m` farther at every ping.
Heard listen(const SmallWorld& world, const UltrasonicSettings& settings, int pings = kPings,
             const RobotDescription& robot = make_ring(), int which = 0, double step_m = 0.0) {
  const UltrasonicRing ring(settings, world.scene, robot, 5);
  Heard heard;
  for (int tick = 0; tick < pings; ++tick) {
    const Pose3 T_world_body{{step_m * tick, 0.0, 0.3}, Eigen::Quaterniond::Identity()};
    for (const UltrasonicRange& range : ring.ping(T_world_body, Time{}, static_cast<std::uint64_t>(tick))) {
      if (range.transducer != which) continue;
      ++heard.pings;
      if (range.range_m == kSilence) ++heard.silent;
      if (range.range_m == -kSilence) ++heard.too_close;
      if (std::isfinite(range.range_m)) heard.range_m.add(range.range_m);
    }
  }
  return heard;
}

double share_tolerance(double share, int n) { return 4.0 * std::sqrt(share * (1.0 - share) / n); }

// Of 149 rays three must be back: the third leaves 17.5 deg sqrt(2.5 / 149) = 2.3 degrees off the axis: 1.6 mm at 2 m.
TEST(Ultrasonic, AWallSquarelyAheadIsReadTo2Millimetres) {
  const Heard heard = listen(SmallWorld(wall(2.0)), ideal(), 100);
  EXPECT_EQ(heard.range_m.count, 100);
  EXPECT_NEAR(heard.range_m.smallest, 2.001, 0.001);
  EXPECT_NEAR(heard.range_m.largest, 2.001, 0.001);
}

TEST(Ultrasonic, NoiseIs5Millimetres) {
  UltrasonicSettings settings = ideal();
  settings.range_noise_std_m = 0.005;
  EXPECT_NEAR(listen(SmallWorld(wall(2.0)), settings).range_m.std(), 0.005, 4.0 * 0.005 / std::sqrt(2.0 * kPings));
}

TEST(Ultrasonic, ReadingsAreWholeCentimetres) {
  UltrasonicSettings settings;
  settings.dropout_probability = 0.0;
  const SmallWorld world(wall(1.237));
  const UltrasonicRing ring(settings, world.scene, make_ring(), 1);
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const double cm = 100.0 * static_cast<double>(ring.ping({{0, 0, 0.3}, {}}, Time{}, tick).front().range_m);
    EXPECT_NEAR(cm, std::round(cm), 1e-4);
  }
}

// Speeds of sound are as the roots of 288.15 K and 293.15 K.
TEST(Ultrasonic, InAirOf15DegreesSetFor20EverythingReads0_86PercentFarther) {
  UltrasonicSettings settings = ideal();
  settings.air_temperature_c = 15.0;
  const SmallWorld world(wall(3.0));
  const double warm = listen(world, ideal(), 50).range_m.mean(), cold = listen(world, settings, 50).range_m.mean();
  EXPECT_NEAR(cold / warm, std::sqrt(293.15 / 288.15), 1e-6);
}

TEST(Ultrasonic, OnePingIn50IsLostForNoReason) {
  UltrasonicSettings settings = ideal();
  settings.dropout_probability = 0.02;
  EXPECT_NEAR(listen(SmallWorld(wall(2.0)), settings).share_silent(), 0.02, share_tolerance(0.02, kPings));
}

TEST(Ultrasonic, NearerThan20CentimetresIsTooCloseAndBeyond4MetresIsSilence) {
  EXPECT_EQ(listen(SmallWorld(wall(0.19)), ideal(), 50).too_close, 50);
  EXPECT_EQ(listen(SmallWorld(wall(0.21)), ideal(), 50).range_m.count, 50);
  EXPECT_EQ(listen(SmallWorld(wall(3.97)), ideal(), 50).range_m.count, 50);
  EXPECT_EQ(listen(SmallWorld(wall(4.01)), ideal(), 50).silent, 50);
  EXPECT_EQ(listen(SmallWorld(""), ideal(), 50).silent, 50);
}

// The cone reaches 17.5 degrees aside, a smooth wall answers to 25: beyond 42.5 degrees no ray can come back.
TEST(Ultrasonic, ASmoothWallIsHeardAt20DegreesAndAMirrorAt45WhereRockIsHeard) {
  EXPECT_EQ(listen(SmallWorld(wall(2.0, 20.0)), ideal(), 50).silent, 0);
  EXPECT_EQ(listen(SmallWorld(wall(2.0, 45.0)), ideal(), 50).silent, 50);
  EXPECT_EQ(listen(SmallWorld(wall(2.0, 45.0, "rock_3")), ideal(), 50).silent, 0);
}

/// Six bars 2 cm thick and 1 m long across the way, on the floor: 6 cm wide, two high.
std::string rebar_bundle(double x_m) {
  std::string bars;
  for (int bar = 0; bar < 6; ++bar) {
    bars += fmt::format(R"(<geom type="capsule" pos="{} 0 {}" euler="90 0 0" size="0.01 0.5"/>)",
                        x_m + 0.02 * (bar % 3), 0.01 + 0.02 * (bar / 3));
  }
  return bars;
}

TEST(Ultrasonic, ARoundBarOf6CentimetresOnTheFloorIsHeardAtOneMetre) {
  // At 1 m the lower edge of the cone is 1 cm above the floor: 0.3 - 1.0 tan 17.5 = -0.015.
  const SmallWorld world(
      R"(<geom type="plane" size="20 20 1"/><geom type="capsule" pos="1.03 0 0.03" euler="90 0 0" size="0.03 0.5"/>)");
  RobotDescription robot = make_ring();
  robot.T_body_sensor["ultrasonic_0"].position.z() = -0.1;  // mounted 0.2 m above the ground
  const Heard heard = listen(world, ideal(), 500, robot);
  EXPECT_GE(heard.range_m.count, 475);
  EXPECT_NEAR(heard.range_m.mean(), std::hypot(1.03, 0.17) - 0.03, 0.03);
}

TEST(Ultrasonic, ABundleOfRebar4CentimetresHighIsHeardAtOneMetre) {
  const SmallWorld world(R"(<geom type="plane" size="20 20 1"/>)" + rebar_bundle(1.0));
  RobotDescription robot = make_ring();
  robot.T_body_sensor["ultrasonic_0"].position.z() = -0.1;
  EXPECT_GE(listen(world, ideal(), 500, robot).range_m.count, 400);
}

/// Rubble as a mesh of triangles: heights at random every 10 cm. Neighbours differ by root 2 times their standard
/// deviation, so that with 11 mm facets slope by 9 degrees (RMS, each way), and with 50 mm by 35.
std::string rubble_asset(double height_std_m) {
  const RandomStream height(3, "rubble");
  constexpr int kColumns = 120, kRows = 50;
  std::string vertices, faces;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kColumns; ++col) {
      const double z = height_std_m * height.normal(static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(col));
      vertices += fmt::format("{:.3f} {:.3f} {:.4f} ", 0.1 * col, 0.1 * row - 2.45, z);
      if (row == 0 || col == 0) continue;
      const int here = row * kColumns + col;
      faces += fmt::format("{} {} {} {} {} {} ", here - kColumns - 1, here - kColumns, here, here - kColumns - 1, here,
                           here - 1);
    }
  }
  return fmt::format(R"(<mesh name="rubble" inertia="shell" vertex="{}" face="{}"/>)", vertices, faces);
}

TEST(Ultrasonic, ThePlainFloorAndRubbleThatTheConeGrazesAreNotHeard) {
  EXPECT_EQ(listen(SmallWorld(R"(<geom type="plane" size="50 50 1"/>)"), ideal(), 200, make_ring(), 0, 0.01).silent,
            200);
  const SmallWorld world(R"(<geom name="rubble" type="mesh" mesh="rubble"/>)", rubble_asset(0.011));
  const Heard heard = listen(world, ideal(), 500, make_ring(), 0, 0.01);
  EXPECT_GE(heard.share_silent(), 0.99);
}

TEST(Ultrasonic, HeapsOfRubbleAreHeardNowAndThenFromLowDown) {
  const SmallWorld world(R"(<geom name="rubble" type="mesh" mesh="rubble"/>)", rubble_asset(0.05));
  RobotDescription robot = make_ring();
  robot.T_body_sensor["ultrasonic_0"].position.z() = -0.1;  // 0.2 m above the mean
  const Heard heard = listen(world, ideal(), 500, robot, 0, 0.01);
  EXPECT_GT(heard.share_silent(), 0.3);
  EXPECT_LT(heard.share_silent(), 0.9);
}

TEST(Ultrasonic, AKerbOf10CentimetresInTheRubbleIsHeard) {
  const SmallWorld world(
      R"(<geom name="rubble" type="mesh" mesh="rubble"/><geom type="box" pos="6.1 0 0" size="0.1 2 0.1"/>)",
      rubble_asset(0.011));
  const Heard near_by = listen(world, ideal(), 100, [] {
    RobotDescription robot = make_ring();
    robot.T_body_sensor["ultrasonic_0"].position = {4.8, 0.0, -0.05};
    return robot;
  }());
  EXPECT_EQ(near_by.silent, 0);
  EXPECT_NEAR(near_by.range_m.mean(), 1.2, 0.05);
}

// A post ahead of transducer 0; transducer 1 looks 22 degrees past it: out of its cone (17.5), within earshot (35).
const std::string kPost = R"(<geom type="cylinder" pos="1.1 0 0.3" size="0.1 1"/>)";

TEST(Ultrasonic, FiredTogetherHalfThePingsTakeTheOthersEchoAndFiredInTurnNone) {
  const SmallWorld world(kPost);
  const RobotDescription robot = make_ring({0.0, -0.2}, {0.0, -22.0});
  UltrasonicSettings together = ideal();
  together.group_size = 2;
  const Heard crossed = listen(world, together, kPings, robot, 1);
  EXPECT_NEAR(1.0 - crossed.share_silent(), 0.5, share_tolerance(0.5, kPings));
  // From 0 to the post's front and back to 1: (1.0 + hypot(1.0, 0.2)) / 2 = 1.010, and some mm for the third ray.
  EXPECT_NEAR(crossed.range_m.mean(), 1.010, 0.005);
  EXPECT_EQ(listen(world, ideal(), kPings, robot, 1).range_m.count, 0);
  EXPECT_EQ(listen(world, together, 100, robot, 0).silent, 0);
}

TEST(Ultrasonic, TheRingOf8FiresInTurnAndInPairsAcross) {
  const SmallWorld world("");
  const RobotDescription robot = make_ring(std::vector<double>(8, 0.0), std::vector<double>(8, 0.0));
  const auto fired_in = [&](int group_size, std::uint64_t tick) {
    UltrasonicSettings settings = ideal();
    settings.group_size = group_size;
    std::vector<int> fired;
    for (const auto& range : UltrasonicRing(settings, world.scene, robot, 1).ping({}, Time{}, tick))
      fired.push_back(range.transducer);
    return fired;
  };
  EXPECT_EQ(fired_in(1, 0), std::vector{0});
  EXPECT_EQ(fired_in(1, 7), std::vector{7});
  EXPECT_EQ(fired_in(1, 8), std::vector{0});
  EXPECT_EQ(fired_in(2, 1), (std::vector{1, 5}));
  EXPECT_EQ(fired_in(3, 2), (std::vector{2, 5}));  // three slots: 0 3 6, 1 4 7, 2 5
}

TEST(Ultrasonic, WithoutNoiseTheSamePingsAreLost) {
  const SmallWorld world(wall(2.0));
  UltrasonicSettings noisy, quiet;
  quiet.range_noise_std_m = quiet.range_quantization_m = 0.0;
  const UltrasonicRing a(noisy, world.scene, make_ring(), 9), b(quiet, world.scene, make_ring(), 9);
  const Pose3 T_world_body{{0, 0, 0.3}, {}};
  int lost = 0;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    const bool is_lost = std::isinf(a.ping(T_world_body, Time{}, tick)[0].range_m);
    EXPECT_EQ(is_lost, std::isinf(b.ping(T_world_body, Time{}, tick)[0].range_m));
    lost += is_lost;
  }
  EXPECT_GT(lost, 5);
}

std::string error_text(const UltrasonicSettings& settings, const RobotDescription& robot) {
  const SmallWorld world("");
  try {
    UltrasonicRing ring(settings, world.scene, robot, 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Ultrasonic, ARobotWithoutTransducersAndSlotsTooShortAreRefusedInASentence) {
  EXPECT_EQ(error_text({}, make_ring({}, {})), "robot carrier: link not found: ultrasonic_0");
  UltrasonicSettings fast;
  fast.ping_rate_hz = 50.0;
  EXPECT_EQ(error_text(fast, make_ring()),
            "sensors.ultrasonic.ping_rate_hz = 50: must be at most 42.5, so that an echo from range_max_m = 4 returns "
            "before the next ping");
}

}  // namespace
}  // namespace patrol::sim::ultrasonic_test
