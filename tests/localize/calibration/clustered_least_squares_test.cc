#include "localize/calibration/clustered_least_squares.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::localize::clustered_least_squares_test {
namespace {

constexpr int kSeeds = 200;
const Eigen::Vector2d kPriorStd(0.5, 2.0);

/// Regressors that change within seconds, and errors with a variance of 1 and a given correlation from one measurement
/// to the next, ten per second.
struct Plant {
  RandomStream random;
  double correlation;
  Eigen::Vector2d parameters;
  double error = 0.0;

  Plant(int seed, double correlation_per_step)
      : random(static_cast<std::uint64_t>(seed), "plant"),
        correlation(correlation_per_step),
        parameters(kPriorStd.x() * random.normal(0), kPriorStd.y() * random.normal(1)) {}

  LinearMeasurement measurement(int k) {
    const double innovation = random.normal(static_cast<std::uint64_t>(k) + 10);
    error = k == 0 ? innovation : correlation * error + std::sqrt(1.0 - correlation * correlation) * innovation;
    LinearMeasurement measured{.stamp = from_seconds(0.1 * k),
                               .J = Eigen::MatrixXd(1, 2),
                               .r = Eigen::VectorXd(1),
                               .W = Eigen::MatrixXd::Identity(1, 1)};
    measured.J << 1.0, std::sin(0.13 * k) + 0.5 * std::sin(0.031 * k);
    measured.r = measured.J * parameters + Eigen::VectorXd::Constant(1, error);
    return measured;
  }
};

/// Normalized estimation error squared, divided by its dimension, averaged over the seeds.
double mean_nees(double correlation, int num_measurements) {
  double sum = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Plant plant(seed, correlation);
    ClusteredLeastSquares filter(kPriorStd, {});
    for (int k = 0; k < num_measurements; ++k) filter.add(plant.measurement(k));
    const LinearEstimate estimate = filter.estimate();
    const Eigen::VectorXd error = estimate.value - plant.parameters;
    sum += error.dot(estimate.covariance.inverse() * error) / 2.0;
  }
  return sum / kSeeds;
}

TEST(ClusteredLeastSquares, IsConsistentForWhiteErrors) { EXPECT_NEAR(mean_nees(0.0, 1000), 1.0, 0.35); }

// Errors correlated over a second: the nominal covariance would give a NEES near 20.
TEST(ClusteredLeastSquares, IsConsistentForCorrelatedErrors) {
  EXPECT_GT(mean_nees(0.9, 1000), 0.6);
  EXPECT_LT(mean_nees(0.9, 1000), 1.6);
  EXPECT_LT(mean_nees(0.9, 300), 2.0);
}

TEST(ClusteredLeastSquares, KeepsThePriorOfAParameterThatIsNotMeasured) {
  ClusteredLeastSquares filter(kPriorStd, {});
  for (int k = 0; k < 300; ++k) {
    LinearMeasurement measurement{.stamp = from_seconds(0.1 * k),
                                  .J = Eigen::MatrixXd(1, 2),
                                  .r = Eigen::VectorXd::Constant(1, 0.3),
                                  .W = Eigen::MatrixXd::Identity(1, 1)};
    measurement.J << 1.0, 0.0;
    filter.add(measurement);
  }
  EXPECT_NEAR(filter.estimate().value[0], 0.3, 0.01);
  EXPECT_DOUBLE_EQ(filter.estimate().value[1], 0.0);
  EXPECT_NEAR(filter.estimate().std(1), kPriorStd.y(), 1e-9);
}

TEST(ClusteredLeastSquares, MergesGroupsWithoutChangingTheEstimate) {
  Plant plant(1, 0.5);
  ClusteredLeastSquares few(kPriorStd, {.max_groups = 8}), many(kPriorStd, {.max_groups = 1000});
  for (int k = 0; k < 2000; ++k) {
    const LinearMeasurement measurement = plant.measurement(k);
    few.add(measurement);
    many.add(measurement);
  }
  EXPECT_TRUE(few.estimate().value.isApprox(many.estimate().value, 1e-9));
  EXPECT_NEAR(few.estimate().std(0) / many.estimate().std(0), 1.0, 0.6);
}

TEST(ClusteredLeastSquares, MeasuresDistancesInUnitsOfTheActualErrors) {
  Plant plant(2, 0.0);
  ClusteredLeastSquares filter(kPriorStd, {});
  for (int k = 0; k < 1000; ++k) {
    LinearMeasurement measurement = plant.measurement(k);
    measurement.W *= 25.0;  // five times too confident
    filter.add(measurement);
  }
  LinearMeasurement far = plant.measurement(1000);
  far.W *= 25.0;
  far.r = far.J * plant.parameters + Eigen::VectorXd::Constant(1, 4.0);
  EXPECT_NEAR(filter.distance(far), 16.0, 3.0);
}

}  // namespace
}  // namespace patrol::localize::clustered_least_squares_test
