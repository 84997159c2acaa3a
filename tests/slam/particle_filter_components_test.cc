#include "slam/particle_filter_components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/settings.h"
#include "slam/swarm/bat.h"
#include "slam/swarm/firefly.h"
#include "slam/swarm/sand_cat.h"
#include "slam/swarm/whale.h"

namespace patrol::slam::particle_filter_components_test {
namespace {

using ::testing::HasSubstr;

template <typename Optimizer>
bool makes(const char* name) {
  return dynamic_cast<const Optimizer*>(make_components({.optimizer = name}).optimizer.get()) != nullptr;
}

TEST(MakeComponents, EachOfSixNamesIsItsOptimizer) {
  EXPECT_TRUE(makes<WhaleOptimizer>("woa"));
  EXPECT_TRUE(makes<BatOptimizer>("ba"));
  EXPECT_TRUE(makes<FireflyOptimizer>("fa"));
  EXPECT_TRUE(makes<ImprovedFireflyOptimizer>("ifa"));
  EXPECT_TRUE(makes<SandCatOptimizer>("scso"));
  EXPECT_TRUE(makes<SandCatOptimizer>("iscso"));
  EXPECT_EQ(make_components({}).optimizer, nullptr);
}

/// Number of fitness evaluations for four particles and three generations: 4 at the start and 4 per generation.
int num_evaluations(const char* name) {
  int count = 0;
  const Fitness fitness_of = [&](std::size_t, const Position& position) {
    ++count;
    return -position.squaredNorm();
  };
  RandomSequence random(RandomStream(1, "test/parts"), 0);
  Swarm swarm = make_swarm(std::vector<Position>(4, Eigen::Vector2d(1.0, 2.0)), fitness_of);
  make_components({.optimizer = name, .optimizer_iterations = 3}).optimizer->move(swarm, fitness_of, random);
  return count;
}

// The improved sand cats also evaluate 3 mutations and ceil(3 sin 30), ceil(3 sin 60), 3 substitutes: 2 + 3 + 3.
TEST(MakeComponents, OptimizersGoThroughThreeGenerations) {
  for (const char* name : {"woa", "fa", "ifa", "scso"}) EXPECT_EQ(num_evaluations(name), 16) << name;
  EXPECT_EQ(num_evaluations("iscso"), 16 + 3 + 8);
}

// Weights of 0.7 and 3 x 0.1: each resampler has a mark of its own.
TEST(MakeComponents, EachOfFiveNamesIsItsResampler) {
  const std::vector<double> weights = {0.7, 0.1, 0.1, 0.1};
  const auto same = [&](const char* name, const Resampler& expected) {
    RandomSequence random(RandomStream(1, "test/parts"), 0), again(RandomStream(1, "test/parts"), 0);
    const std::vector<Offspring> got = make_components({.resampler = name}).resample(weights, random),
                                 want = expected(weights, again);
    for (std::size_t i = 0; i < want.size(); ++i) {
      EXPECT_EQ(got[i].parent, want[i].parent) << name;
      EXPECT_EQ(got[i].attractor, want[i].attractor) << name;
      EXPECT_EQ(got[i].attraction, want[i].attraction) << name;
      EXPECT_EQ(got[i].mutation, want[i].mutation) << name;
    }
    return got;
  };
  same("multinomial", resample_multinomial);
  same("systematic", resample_systematic);
  same("residual", resample_residual);
  EXPECT_GT(same("low_weight", optimize_low_weights).back().attraction, 0.0);
  EXPECT_NE(same("stepwise", [](const auto& w, RandomSequence& random) { return resample_stepwise(w, random); })
                .back()
                .mutation,
            0.0);
}

TEST(MakeComponents, RefusesUnknownNamesAndValuesOutOfRange) {
  const auto complaint = [](const ParticleFilterSettings& settings) -> std::string {
    try {
      make_components(settings);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(complaint({.optimizer = "ant"}), HasSubstr("optimizer"));
  EXPECT_THAT(complaint({.optimizer_iterations = 0}), HasSubstr("optimizer_iterations"));
  EXPECT_THAT(complaint({.firefly_absorption = -0.1}), HasSubstr("firefly_absorption"));
  EXPECT_THAT(complaint({.resampler = "roulette"}), HasSubstr("resampler"));
  EXPECT_THAT(complaint({.resample_threshold = 1.1}), HasSubstr("resample_threshold"));
}

}  // namespace
}  // namespace patrol::slam::particle_filter_components_test
