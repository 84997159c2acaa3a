#include "sim/locomotion/force_distribution.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace patrol::sim::force_distribution_test {
namespace {

const FootVectors kFeet = {Eigen::Vector3d(0.19, 0.14, -0.30), Eigen::Vector3d(0.20, -0.13, -0.29),
                           Eigen::Vector3d(-0.18, 0.14, -0.30), Eigen::Vector3d(-0.19, -0.14, -0.31)};
constexpr FootFlags kAll = {true, true, true, true};

Eigen::Vector3d total_force(const FootVectors& forces) { return forces[0] + forces[1] + forces[2] + forces[3]; }

Eigen::Vector3d total_moment(const FootVectors& forces) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) moment += kFeet[leg].cross(forces[leg]);
  return moment;
}

TEST(ForceDistribution, FourFeetGiveTheWholeWrenchWithin1PerMille) {
  const Eigen::Vector3d force(12.0, -6.0, 130.0), moment(2.0, -3.0, 1.0);
  const FootVectors forces = distribute_wrench(force, moment, kFeet, kAll, {});
  EXPECT_NEAR((total_force(forces) - force).norm(), 0.0, 0.001 * force.norm());
  EXPECT_NEAR((total_moment(forces) - moment).norm(), 0.0, 0.005 * moment.norm());
}

TEST(ForceDistribution, TheWeightOverTheMiddleOfASquareIsSharedInFour) {
  const FootVectors square = {Eigen::Vector3d(0.2, 0.15, -0.3), Eigen::Vector3d(0.2, -0.15, -0.3),
                              Eigen::Vector3d(-0.2, 0.15, -0.3), Eigen::Vector3d(-0.2, -0.15, -0.3)};
  const FootVectors forces = distribute_wrench({0, 0, 120}, {0, 0, 0}, square, kAll, {});
  for (const Eigen::Vector3d& force : forces) EXPECT_NEAR((force - Eigen::Vector3d(0, 0, 30)).norm(), 0.0, 0.01);
}

TEST(ForceDistribution, FeetInTheAirGetNothingAndTheDiagonalPairCarriesTheWeight) {
  const FootVectors forces = distribute_wrench({0, 0, 120}, {0, 0, 0}, kFeet, {true, false, false, true}, {});
  EXPECT_EQ(forces[1], Eigen::Vector3d::Zero());
  EXPECT_EQ(forces[2], Eigen::Vector3d::Zero());
  EXPECT_NEAR(total_force(forces).z(), 120.0, 1.0);
}

TEST(ForceDistribution, NoFootPullsPushesBeyondItsLimitOrLeavesItsFrictionPyramid) {
  const FrictionLimits limits{.coefficient = 0.6, .min_normal_n = 5.0, .max_normal_n = 220.0};
  for (const double push : {-400.0, -100.0, 0.0, 100.0, 400.0}) {
    const FootVectors forces =
        distribute_wrench({push, 0.5 * push, 3.0 * push}, {0.1 * push, 0, 0}, kFeet, kAll, limits);
    for (const Eigen::Vector3d& force : forces) {
      EXPECT_GE(force.z(), 5.0);
      EXPECT_LE(force.z(), 220.0);
      EXPECT_LE(std::abs(force.x()), 0.6 * force.z() + 1e-9);
      EXPECT_LE(std::abs(force.y()), 0.6 * force.z() + 1e-9);
    }
  }
}

// Clipped only, the two others push with 1.3 to 1.8 times the weight to make up for the foot that cannot pull.
TEST(ForceDistribution, AFootThatWouldHaveToPullDoesNotMakeTheOthersLiftTheRobotWithMoreThan10PercentAboveItsWeight) {
  const FootFlags without_front_left = {false, true, true, true};
  const FrictionLimits limits{.coefficient = 0.6, .min_normal_n = 5.0, .max_normal_n = 220.0},
      clips_only{.coefficient = 0.6, .min_normal_n = 5.0, .max_normal_n = 220.0, .redistributes = false};
  for (const double roll_nm : {12.0, 20.0, 30.0}) {
    const FootVectors forces = distribute_wrench({0, 0, 133}, {roll_nm, 0, 0}, kFeet, without_front_left, limits);
    EXPECT_EQ(forces[0], Eigen::Vector3d::Zero());
    EXPECT_NEAR(forces[3].z(), 5.0, 1e-9);
    EXPECT_NEAR(total_force(forces).z(), 133.0, 13.3) << roll_nm;
    const FootVectors clipped = distribute_wrench({0, 0, 133}, {roll_nm, 0, 0}, kFeet, without_front_left, clips_only);
    EXPECT_GT(total_force(clipped).z(), 1.3 * 133.0) << roll_nm;
  }
}

TEST(ForceDistribution, OfAllForcesThatGiveTheWrenchItTakesTheSmallest) {
  const Eigen::Vector3d force(12.0, -6.0, 130.0);
  const FootVectors forces = distribute_wrench(force, {0, 0, 0}, kFeet, kAll, {});
  double squares = 0.0;
  for (const Eigen::Vector3d& f : forces) squares += f.squaredNorm();
  // An internal force, along the line of two feet, changes no wrench and can only add.
  const Eigen::Vector3d along = (kFeet[0] - kFeet[1]).normalized();
  for (const double inner : {-3.0, -0.5, 0.5, 3.0}) {
    const double other = squares + (forces[0] + inner * along).squaredNorm() - forces[0].squaredNorm() +
                         (forces[1] - inner * along).squaredNorm() - forces[1].squaredNorm();
    EXPECT_GT(other, squares);
  }
}

}  // namespace
}  // namespace patrol::sim::force_distribution_test
