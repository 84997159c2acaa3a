#include "slam/submaps/submap_constraint_finder.h"

#include <gtest/gtest.h>

#include "slam/scan_integration.h"
#include "tests/slam/submaps/submap_drive.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::submap_constraint_finder_test {
namespace {

/// Surfaces observed on 8 m along a corridor from (x, y) on, in the frame of the first scan.
SubmapSurfaces seen_from(const test::RoomWorld& world, double x, double y, std::uint64_t seed) {
  const RandomStream noise(seed, "test/joiner");
  const Pose2 T_world_first{x, y, 0.0};
  GridMap map(0.05, 200.0);
  for (std::uint64_t k = 0; k < 17; ++k) {
    const Pose2 T_first_body{0.5 * static_cast<double>(k), 0.0, 0.0};
    integrate_scan(world.scan(T_world_first * T_first_body, {}, test::kOldLidar, noise, k), T_first_body, {}, map);
  }
  return *describe_surfaces(map, {});
}

PoseGaussian prediction_of(const Pose2& mean, double std_m, double std_rad) {
  return {.mean = mean, .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

// Four meters apart, predicted 0.3 m and 1 degree off.
TEST(FindConstraint, NeighborsInTheOfficeAreConstrainedToTwoCentimeters) {
  const SubmapSurfaces target = seen_from(test::make_office(), 10.0, 4.2, 1),
                       source = seen_from(test::make_office(), 14.0, 4.2, 2);
  const ConstraintResult result = find_constraint(target, source, prediction_of({4.25, 0.15, 0.017}, 0.3, 0.02),
                                                  test::agreeing_neighbors(), {}, {});
  ASSERT_TRUE(result.constraint);
  EXPECT_EQ(result.failure, ConstraintRejection::kNone);
  EXPECT_THAT(result.constraint->T_target_source, test::Pose2Near(Pose2{4.0, 0.0, 0.0}, 0.02, 0.003));
}

TEST(FindConstraint, WithoutAModelTheyAreNotNeighbors) {
  const SubmapSurfaces submap = seen_from(test::make_office(), 10.0, 4.2, 1);
  EXPECT_EQ(find_constraint(submap, submap, prediction_of({}, 0.1, 0.01), {}, {}, {}).failure,
            ConstraintRejection::kNotNeighbors);
}

// Doors every three meters: known to 0.3 m there is one place, known to 2 m there are others.
TEST(FindConstraint, AmongIdenticalDoorsAnAmbiguousMatchIsRejected) {
  const test::RoomWorld doors = test::make_corridor_of_doors();
  const SubmapSurfaces target = seen_from(doors, 36.0, 0.0, 1), source = seen_from(doors, 39.0, 0.0, 2);
  SubmapConstraintSettings any;
  any.min_margin = -1.0;
  const BoostedStumps all = test::agreeing_neighbors();
  const ConstraintResult sure =
      find_constraint(target, source, prediction_of({3.0, 0.0, 0.0}, 0.2, 0.01), all, {}, any);
  ASSERT_TRUE(sure.constraint);
  EXPECT_THAT(sure.constraint->T_target_source, test::Pose2Near(Pose2{3.0, 0.0, 0.0}, 0.05, 0.005));
  EXPECT_EQ(find_constraint(target, source, prediction_of({3.0, 0.0, 0.0}, 2.0, 0.01), all, {}, any).failure,
            ConstraintRejection::kAmbiguous);
}

TEST(FindConstraint, AMatchThatLeavesTheRecognizedPoseIsRejected) {
  const SubmapSurfaces target = seen_from(test::make_office(), 10.0, 4.2, 1),
                       source = seen_from(test::make_office(), 14.0, 4.2, 2);
  SubmapConstraintSettings narrow;
  narrow.max_fine_shift_m = 0.0;
  EXPECT_EQ(find_constraint(target, source, prediction_of({4.25, 0.15, 0.017}, 0.3, 0.02), test::agreeing_neighbors(),
                            {}, narrow)
                .failure,
            ConstraintRejection::kMismatch);
}

}  // namespace
}  // namespace patrol::slam::submap_constraint_finder_test
