#include "slam/particle_filter.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "slam/swarm/whale.h"

namespace patrol::slam::particle_filter_test {
namespace {

/// A number that wanders and is measured: x' = a x + b + q w, z = x + r v. All is normal, so that the Kalman filter is
/// exact.
struct Walk {
  double a = 0.9, b = 1.0, q = 0.5, r = 0.8;
};

/// One step of a bootstrap filter on it: a particle's position is where it goes.
class WalkProblem {
 public:
  WalkProblem(const Walk& walk, double z, std::vector<double>& states) : walk_(walk), z_(z), states_(states) {}

  std::size_t size() const { return states_.size(); }
  Position sample(std::size_t i, RandomSequence& random) const {
    return at(walk_.a * states_[i] + walk_.b + walk_.q * random.normal());
  }
  double log_fitness(std::size_t, const Position& position) const {
    return -0.5 * std::pow((z_ - position(0)) / walk_.r, 2);
  }
  double commit(std::size_t i, const Position& position) {
    states_[i] = position(0);
    return log_fitness(i, position);
  }
  void apply_resampling(const std::vector<Offspring>& offspring) {
    std::vector<double> children;
    for (const Offspring& child : offspring) children.push_back(states_[child.parent]);
    states_ = children;
    ++num_renewals;
  }

  int num_renewals = 0;

 private:
  static Position at(double x) { return Eigen::Matrix<double, 1, 1>(x); }

  Walk walk_;
  double z_;
  std::vector<double>& states_;
};

struct Gaussian {
  double mean = 0.0, variance = 1.0;
};

Gaussian kalman(const Walk& walk, const Gaussian& before, double z) {
  const Gaussian predicted{walk.a * before.mean + walk.b, walk.a * walk.a * before.variance + walk.q * walk.q};
  const double gain = predicted.variance / (predicted.variance + walk.r * walk.r);
  return {predicted.mean + gain * (z - predicted.mean), (1.0 - gain) * predicted.variance};
}

Gaussian moments_of(const std::vector<double>& states, const std::vector<double>& weights) {
  Gaussian moments{0.0, 0.0};
  for (std::size_t i = 0; i < states.size(); ++i) moments.mean += weights[i] * states[i];
  for (std::size_t i = 0; i < states.size(); ++i)
    moments.variance += weights[i] * std::pow(states[i] - moments.mean, 2);
  return moments;
}

/// Calls see(step, Kalman's answer, the particles', their effective number) after each of 20 measurements.
template <typename See>
void compare(const ParticleFilterComponents& components, std::size_t particles, const See& see) {
  const Walk walk;
  const RandomStream world(7, "test/walk"), draws(7, "test/filter");
  std::vector<double> states, log_weights(particles, 0.0);
  for (std::size_t i = 0; i < particles; ++i) states.push_back(world.normal(0, i + 10));
  Gaussian exact;
  double truth = 0.5;
  for (std::uint64_t k = 0; k < 20; ++k) {
    truth = walk.a * truth + walk.b + walk.q * world.normal(k + 1, 0);
    const double z = truth + walk.r * world.normal(k + 1, 1);
    WalkProblem problem(walk, z, states);
    RandomSequence random(draws, k);
    propagate_and_weight(problem, components, random, log_weights);
    const std::vector<double> weights = normalized_weights(log_weights);
    exact = kalman(walk, exact, z);
    see(static_cast<int>(k), exact, moments_of(states, weights), effective_sample_size(weights));
    resample_if_depleted(problem, components, weights, random, log_weights);
  }
}

// Four standard errors. Of a weighted mean they are sqrt(P / N_eff), of a variance sqrt(2 P^2 / N_eff); twice the
// variance, since the error before comes on top: it is multiplied by (a (1 - gain))^2 < 1 / 4 in each step, and
// resampling adds P / N.
TEST(ParticleFilter, FiveThousandParticlesAgreeWithTheKalmanFilter) {
  for (const char* resampler : {"multinomial", "systematic", "residual"}) {
    compare(make_components({.resampler = resampler}), 5000,
            [&](int step, const Gaussian& exact, const Gaussian& particles, double n) {
              EXPECT_NEAR(particles.mean, exact.mean, 4.0 * std::sqrt(2.0 * exact.variance / n))
                  << resampler << ", step " << step;
              EXPECT_NEAR(particles.variance, exact.variance, 4.0 * exact.variance * std::sqrt(2.0 * 2.0 / n))
                  << resampler << ", step " << step;
            });
  }
}

// What a swarm does to the distribution is not undone: the same particles, moved, are narrower than the truth.
TEST(ParticleFilter, ASwarmMakesItOverconfidentByHalfTheVariance) {
  ParticleFilterComponents components;
  components.optimizer = std::make_shared<WhaleOptimizer>(5);
  double exact_sum = 0.0, sum = 0.0;
  compare(components, 200, [&](int, const Gaussian& exact, const Gaussian& particles, double) {
    exact_sum += exact.variance;
    sum += particles.variance;
  });
  EXPECT_LT(sum, 0.5 * exact_sum);
}

// Without resampling the log weights add up.
TEST(PropagateAndWeight, AddsTheLogLikelihoodToTheLogWeight) {
  std::vector<double> states = {0.0, 1.0}, log_weights = {-1.0, -2.0};
  WalkProblem problem({.a = 1.0, .b = 0.0, .q = 0.0, .r = 1.0}, 1.0, states);
  RandomSequence random(RandomStream(1, "test/filter"), 0);
  propagate_and_weight(problem, {}, random, log_weights);
  EXPECT_EQ(log_weights, (std::vector<double>{-1.5, -2.0}));
  EXPECT_EQ(states, (std::vector<double>{0.0, 1.0}));
}

struct Renewal {
  bool is_renewed;
  int num_renewals;
  std::vector<double> states, log_weights;
};

Renewal renew(std::vector<double> log_weights, double threshold) {
  std::vector<double> states = {0.0, 1.0, 2.0, 3.0};
  WalkProblem problem({}, 0.0, states);
  RandomSequence random(RandomStream(1, "test/filter"), 0);
  ParticleFilterComponents components;
  components.resample_threshold = threshold;
  const bool is_renewed =
      resample_if_depleted(problem, components, normalized_weights(log_weights), random, log_weights);
  return {is_renewed, problem.num_renewals, states, log_weights};
}

// Weights 0.7 and three of 0.1: N_eff = 1 / 0.52 = 1.923 of 4, a share of 0.481.
TEST(ResampleIfDepleted, OnlyBelowTheThreshold) {
  const std::vector<double> logs = {std::log(0.7), std::log(0.1), std::log(0.1), std::log(0.1)};
  const Renewal above = renew(logs, 0.48), below = renew(logs, 0.49);
  EXPECT_FALSE(above.is_renewed);
  EXPECT_EQ(above.num_renewals, 0);
  EXPECT_EQ(above.log_weights, logs);
  EXPECT_EQ(above.states, (std::vector<double>{0.0, 1.0, 2.0, 3.0}));
  EXPECT_TRUE(below.is_renewed);
  EXPECT_EQ(below.num_renewals, 1);
}

// 0.7 x 4 = 2.8: two or three children of the first.
TEST(ResampleIfDepleted, ThenAllFourWeighTheSameAndTheHeavyOneHasTwoOrThreeChildren) {
  const Renewal renewal = renew({std::log(0.7), std::log(0.1), std::log(0.1), std::log(0.1)}, 0.5);
  EXPECT_EQ(renewal.log_weights, std::vector<double>(4, 0.0));
  const auto children = std::count(renewal.states.begin(), renewal.states.end(), 0.0);
  EXPECT_GE(children, 2);
  EXPECT_LE(children, 3);
}

}  // namespace
}  // namespace patrol::slam::particle_filter_test
