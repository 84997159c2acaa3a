#include "tests/support/room_world.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace patrol::test::room_world_test {
namespace {

constexpr double kExactTol = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RoomWorld, FourBeamsInARoomMeetItsFourWalls) {
  RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0);
  const std::vector<double> ranges = room.ranges_m({1.0, 1.0, 0.0}, 4, 30.0);
  EXPECT_NEAR(ranges[0], 4.0, kExactTol);
  EXPECT_NEAR(ranges[1], 3.0, kExactTol);
  EXPECT_NEAR(ranges[2], 4.0, kExactTol);
  EXPECT_NEAR(ranges[3], 3.0, kExactTol);
  EXPECT_NEAR(room.ranges_m({2.0, 1.0, std::numbers::pi}, 4, 30.0)[0], 5.0, kExactTol)
      << "beam 0 looks where the body does";
}

TEST(RoomWorld, BeyondTheRangeThereIsNoEcho) {
  RoomWorld room;
  room.add_wall(10.0, -1.0, 10.0, 1.0);
  EXPECT_EQ(room.ranges_m({}, 4, 9.9)[0], kInfinity);
  EXPECT_NEAR(room.ranges_m({}, 4, 10.1)[0], 10.0, kExactTol);
  EXPECT_EQ(room.ranges_m({}, 4, 10.1)[2], kInfinity);
}

// Each beam against each wall by the two-line formula.
TEST(RoomWorld, EveryBeamMeetsTheNearestWall) {
  RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0)
      .add_post(2.0, 1.5, 0.4)
      .add_wall(-2.0, -1.0, -1.0, 3.0)
      .add_wall(0.5, -1.5, 0.7, -1.6);
  const Pose2 T_world_body{0.3, 0.4, 0.7};
  constexpr int kBeams = 720;
  const std::vector<double> ranges = room.ranges_m(T_world_body, kBeams, 30.0);
  for (int beam = 0; beam < kBeams; ++beam) {
    const double angle = T_world_body.yaw + 2.0 * std::numbers::pi * beam / kBeams;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle)), origin = T_world_body.position();
    double nearest = kInfinity;
    for (const Segment& wall : room.walls()) {
      Eigen::Matrix2d lines;
      lines << direction, wall.a - wall.b;
      if (std::abs(lines.determinant()) < 1e-12) continue;
      const Eigen::Vector2d solution = lines.inverse() * (wall.a - origin);  // range, share of the wall
      if (solution[0] > 0.0 && solution[1] >= -1e-9 && solution[1] <= 1.0 + 1e-9)
        nearest = std::min(nearest, solution[0]);
    }
    EXPECT_NEAR(ranges[static_cast<std::size_t>(beam)], nearest, 1e-6) << beam;
  }
}

TEST(RoomWorld, DistanceIsToTheNearestPointOfAWall) {
  RoomWorld room;
  room.add_wall(0.0, 0.0, 10.0, 0.0);
  EXPECT_NEAR(room.distance_m({5.0, 2.0}), 2.0, kExactTol);
  EXPECT_NEAR(room.distance_m({-3.0, 4.0}), 5.0, kExactTol);
}

TEST(RoomWorld, ScansAreInTheBodyAndNoisyAsAskedFor) {
  RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0);
  const LevelScan exact = room.scan({1.0, 1.0, 0.4}, {.beams = 2000});
  const LevelScan noisy =
      room.scan({1.0, 1.0, 0.4}, Time{}, {.beams = 2000, .range_std_m = 0.02}, RandomStream(1, "test"), 0);
  double sum_of_squares = 0.0;
  for (std::size_t beam = 0; beam < exact.beams.size(); ++beam) {
    ASSERT_TRUE(exact.beams[beam].is_hit);
    sum_of_squares += (noisy.beams[beam].end_m - exact.beams[beam].end_m).squaredNorm();
  }
  // A variance from n draws is right to sqrt(2 / n): four times that.
  EXPECT_NEAR(sum_of_squares / 2000.0, 4e-4, 4e-4 * 4.0 * std::sqrt(2.0 / 2000.0));
}

}  // namespace
}  // namespace patrol::test::room_world_test
