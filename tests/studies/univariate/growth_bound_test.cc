#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "studies/univariate/exact_filter.h"
#include "studies/univariate/growth_filter.h"
#include "studies/univariate/quasi_filter.h"
#include "tests/studies/univariate/growth_runs.h"

/// The exact filter bounds all that see observations alone. What is significantly better has seen more than that, as
/// the figures of [Cui21], table 1, must have.
namespace patrol::studies::growth_bound_test {
namespace {

constexpr std::size_t kSeeds = 40;

std::vector<double> exact_errors() {
  return errors_of([](std::uint64_t, const GrowthRun&) { return std::make_unique<ExactFilter>(GrowthModel()); },
                   GrowthModel(), kSeeds);
}

std::vector<double> swarm_errors(int particles, const slam::ParticleFilterSettings& settings) {
  return errors_of(
      [&](std::uint64_t seed, const GrowthRun&) {
        return std::make_unique<GrowthFilter>(particles, GrowthModel(), slam::make_components(settings), seed);
      },
      GrowthModel(), kSeeds);
}

std::vector<double> quasi_errors(int particles) {
  const QuasiFilterSettings settings{.particles = particles};
  return errors_of([&](std::uint64_t seed,
                       const GrowthRun&) { return std::make_unique<QuasiFilter>(settings, GrowthModel(), seed); },
                   GrowthModel(), kSeeds);
}

/// The whole 95 % interval of the paired difference lies below zero.
bool is_below_bound(const std::vector<double>& errors, const std::vector<double>& bound) {
  return paired_difference(errors, bound).high < 0.0;
}

TEST(GrowthBound, NoFilterIsSignificantlyBelowIt) {
  const std::vector<double> bound = exact_errors();
  for (const int particles : {50, 150}) {
    EXPECT_FALSE(is_below_bound(swarm_errors(particles, {.resample_threshold = 1.0}), bound)) << "PF " << particles;
    EXPECT_FALSE(is_below_bound(swarm_errors(particles, {.optimizer = "ba", .optimizer_iterations = 1}), bound))
        << "BA " << particles;
    EXPECT_FALSE(is_below_bound(swarm_errors(particles, published_ifa_settings()), bound))
        << "IFA as printed " << particles;
    EXPECT_FALSE(is_below_bound(
        swarm_errors(particles, {.optimizer = "ifa", .optimizer_iterations = 1, .firefly_absorption = 1.0}), bound))
        << "IFA " << particles;
    EXPECT_FALSE(is_below_bound(quasi_errors(particles), bound)) << "quasi " << particles;
  }
  EXPECT_FALSE(is_below_bound(
      swarm_errors(50, {.optimizer = "fa", .optimizer_iterations = 1, .firefly_absorption = 1.0}), bound))
      << "FA 50";
}

/// "The newest state value" of eq. 2 read as the true one: every particle moves a fraction of the distance to it.
class LeakingOptimizer : public slam::SwarmOptimizer {
 public:
  LeakingOptimizer(std::vector<double> true_states, double fraction)
      : true_states_(std::move(true_states)), fraction_(fraction) {}

  void move(slam::Swarm& swarm, const slam::Fitness&, RandomSequence&) const override {
    const double truth = true_states_[step_++];
    for (slam::Position& position : swarm.positions) position[0] += fraction_ * (truth - position[0]);
  }

 private:
  std::vector<double> true_states_;
  double fraction_;
  mutable std::size_t step_ = 0;
};

TEST(GrowthBound, CatchesAFilterThatUsesATwentiethOfTheTrueState) {
  const auto leaking = [](std::uint64_t seed, const GrowthRun& run) {
    slam::ParticleFilterComponents parts = slam::make_components({.resample_threshold = 1.0});
    parts.optimizer = std::make_shared<LeakingOptimizer>(run.states, 0.05);
    return std::make_unique<GrowthFilter>(150, GrowthModel(), parts, seed);
  };
  EXPECT_TRUE(is_below_bound(errors_of(leaking, GrowthModel(), kSeeds), exact_errors()));
}

TEST(GrowthBound, OursWithAHundredAndFiftyParticlesIsWithinThreePercentOfIt) {
  const std::vector<double> bound = exact_errors(), ours = quasi_errors(150);
  double mean_bound = 0.0;
  for (const double error : bound) mean_bound += error / static_cast<double>(kSeeds);
  EXPECT_LT(paired_difference(ours, bound).high, 0.03 * mean_bound);
}

}  // namespace
}  // namespace patrol::studies::growth_bound_test
