#include "slam/submaps/adaboost.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::slam::adaboost_test {
namespace {

constexpr double kExactTol = 1e-12;  // algebra

/// Points in the square of 2 m about the origin, labeled by a rule; `flips` of them wrongly.
LabeledFeatures make_square(int count, const std::function<bool(double, double)>& is_positive, double flips = 0.0) {
  const RandomStream random(7, "test/adaboost");
  LabeledFeatures training{.names = {"x", "y"}, .examples = {}, .labels = {}};
  for (int i = 0; i < count; ++i) {
    const auto u = random.uniforms(static_cast<std::uint64_t>(i));
    const double x = 2.0 * u[0] - 1.0, y = 2.0 * u[1] - 1.0;
    training.examples.push_back({x, y});
    training.labels.push_back(is_positive(x, y) != (u[2] < flips) ? 1 : -1);
  }
  return training;
}

int num_wrong(const BoostedStumps& model, const LabeledFeatures& data) {
  int wrong = 0;
  for (std::size_t i = 0; i < data.examples.size(); ++i)
    wrong += model.margin(data.examples[i]) * data.labels[i] > 0.0 ? 0 : 1;
  return wrong;
}

bool in_box(double x, double y) { return std::abs(x) < 0.6 && std::abs(y) < 0.5; }

// Six examples on a line, + + - + - -: the best stump has one wrong, the fourth. e = 1/6, vote 1/2 ln 5.
TEST(AdaBoost, TheFirstStumpIsTheOneWithTheFewestWrong) {
  const LabeledFeatures training{
      .names = {"x"}, .examples = {{0}, {1}, {2}, {3}, {4}, {5}}, .labels = {1, 1, -1, 1, -1, -1}};
  const BoostingResult result = train_adaboost(training, {.rounds = 1});
  ASSERT_EQ(result.model.stumps.size(), 1U);
  EXPECT_EQ(result.model.stumps[0],
            (DecisionStump{.feature = 0, .threshold = 1.5, .sign_above = -1, .weight = result.model.stumps[0].weight}));
  EXPECT_NEAR(result.model.stumps[0].weight, 0.5 * std::log(5.0), kExactTol);
  EXPECT_NEAR(result.errors[0], 1.0 / 6.0, kExactTol);
  EXPECT_NEAR(result.training_error, 1.0 / 6.0, kExactTol);
  EXPECT_NEAR(result.error_bound, 2.0 * std::sqrt(5.0) / 6.0, kExactTol);
}

// After the first round the fourth weighs 1/2, the others 1/10 each: "up to 3.5" has only the third wrong.
TEST(AdaBoost, ThreeStumpsSeparateWhatNoneDoesAlone) {
  const LabeledFeatures training{
      .names = {"x"}, .examples = {{0}, {1}, {2}, {3}, {4}, {5}}, .labels = {1, 1, -1, 1, -1, -1}};
  const BoostingResult result = train_adaboost(training, {.rounds = 3});
  EXPECT_EQ(result.model.stumps.size(), 3U);
  EXPECT_EQ(result.model.stumps[1].threshold, 3.5);
  EXPECT_NEAR(result.errors[1], 0.1, kExactTol);
  EXPECT_EQ(num_wrong(result.model, training), 0);
}

TEST(AdaBoost, ABoxInASquareIsLearnedWithoutAMistakeByThirtyStumps) {
  const LabeledFeatures training = make_square(400, in_box);
  const BoostingResult result = train_adaboost(training, {.rounds = 30});
  EXPECT_EQ(result.training_error, 0.0);
  EXPECT_EQ(num_wrong(result.model, training), 0);
  EXPECT_EQ(train_adaboost(training, {.rounds = 1}).model.stumps.size(), 1U);
  EXPECT_GT(train_adaboost(training, {.rounds = 3}).training_error, 0.05) << "a box has four sides";
}

// Sums of a function of x and one of y: what is right for two opposite quadrants is wrong for the other two.
TEST(AdaBoost, StumpsCannotLearnOppositeQuadrantsButCanFromTheProduct) {
  LabeledFeatures training{
      .names = {"x", "y"}, .examples = {{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}, .labels = {1, -1, -1, 1}};
  const BoostingResult none = train_adaboost(training, {});
  EXPECT_TRUE(none.model.stumps.empty()) << "every stump has half of them wrong";
  EXPECT_EQ(none.training_error, 1.0) << "who says nothing is wrong";
  training.names.push_back("xy");
  for (auto& example : training.examples) example.push_back(example[0] * example[1]);
  const BoostingResult one = train_adaboost(training, {});
  EXPECT_EQ(one.model.stumps,
            (std::vector<DecisionStump>{{.feature = 2, .threshold = 0.0, .sign_above = 1, .weight = 1.0}}));
  EXPECT_EQ(one.training_error, 0.0);
}

TEST(AdaBoost, TheTrainingErrorStaysBelowItsBoundAfterEveryRound) {
  const LabeledFeatures training = make_square(300, in_box, 0.1);
  for (const bool balance : {false, true}) {
    double before = 1.0;
    for (int rounds = 1; rounds <= 60; ++rounds) {
      const BoostingResult result = train_adaboost(training, {.rounds = rounds, .balance_classes = balance});
      double bound = 1.0;
      for (const double e : result.errors) bound *= 2.0 * std::sqrt(e * (1.0 - e));
      EXPECT_NEAR(result.error_bound, bound, kExactTol);
      EXPECT_LE(result.training_error, bound + kExactTol);
      EXPECT_LE(bound, before);
      before = bound;
    }
    EXPECT_LT(before, 0.75) << "it says something";
  }
}

// The product of all factors is the bound itself: sum w exp(-y F) = prod 2 sqrt(e (1 - e)).
TEST(AdaBoost, TheBoundIsTheExponentialLoss) {
  const LabeledFeatures training = make_square(200, in_box, 0.2);
  const BoostingResult result = train_adaboost(training, {.rounds = 20});
  double loss = 0.0;
  for (std::size_t i = 0; i < training.examples.size(); ++i) {
    double votes = 0.0;
    for (const DecisionStump& stump : result.model.stumps) votes += stump.weight * stump.vote(training.examples[i]);
    loss += std::exp(-training.labels[i] * votes) / 200.0;
  }
  EXPECT_NEAR(loss, result.error_bound, 1e-9);
}

TEST(AdaBoost, NoStumpIsTakenTwiceInARow) {
  const LabeledFeatures training = make_square(200, in_box, 0.2);
  const BoostingResult result = train_adaboost(training, {.rounds = 20});
  for (std::size_t i = 1; i < result.model.stumps.size(); ++i) {
    const DecisionStump &a = result.model.stumps[i - 1], &b = result.model.stumps[i];
    EXPECT_FALSE(a.feature == b.feature && a.threshold == b.threshold && a.sign_above == b.sign_above);
  }
}

TEST(AdaBoost, UnseenExamplesAreClassifiedAsWell) {
  const LabeledFeatures all = make_square(3000, in_box, 0.05);
  LabeledFeatures training{.names = all.names, .examples = {}, .labels = {}}, test = training;
  for (std::size_t i = 0; i < all.examples.size(); ++i) {
    LabeledFeatures& part = i < 1000 ? training : test;
    part.examples.push_back(all.examples[i]);
    part.labels.push_back(all.labels[i]);
  }
  const BoostingResult result = train_adaboost(training, {.rounds = 60});
  EXPECT_LT(num_wrong(result.model, test) / 2000.0, 0.05 + 0.03) << "5 % of the labels are wrong";
}

TEST(AdaBoost, BalancedClassesDetectTheRareOne) {
  LabeledFeatures training{.names = {"x"}, .examples = {}, .labels = {}};
  for (int i = 0; i < 100; ++i) {  // one in ten beyond 0.5 is positive
    training.examples.push_back({0.01 * i});
    training.labels.push_back(i > 50 && i % 10 == 5 ? 1 : -1);
  }
  const auto plain = train_adaboost(training, {.rounds = 1}),
             balanced = train_adaboost(training, {.rounds = 1, .balance_classes = true});
  EXPECT_LT(plain.model.margin({0.75}), 0.0);
  EXPECT_GT(balanced.model.margin({0.75}), 0.0);
}

TEST(AdaBoost, TheSameExamplesGiveTheSameModelAndOtherScalesTheSameVotes) {
  const LabeledFeatures training = make_square(200, in_box, 0.1);
  LabeledFeatures scaled = training;
  for (auto& example : scaled.examples) example[1] = 1000.0 * example[1] + 5.0;
  const BoostingResult first = train_adaboost(training, {.rounds = 20}),
                       second = train_adaboost(scaled, {.rounds = 20});
  EXPECT_EQ(first.model, train_adaboost(training, {.rounds = 20}).model);
  EXPECT_EQ(first.errors, second.errors);
  for (std::size_t i = 0; i < training.examples.size(); ++i)
    EXPECT_EQ(first.model.margin(training.examples[i]), second.model.margin(scaled.examples[i]));
}

TEST(BoostedStumps, TheMarginIsTheFractionOfVotes) {
  const BoostedStumps model{.features = {"x", "y"},
                            .stumps = {{.feature = 0, .threshold = 1.0, .sign_above = 1, .weight = 3.0},
                                       {.feature = 1, .threshold = 0.0, .sign_above = -1, .weight = 1.0}}};
  EXPECT_EQ(model.margin({2.0, -1.0}), 1.0);
  EXPECT_EQ(model.margin({2.0, 1.0}), 0.5);
  EXPECT_EQ(model.margin({1.0, 1.0}), -1.0) << "at the threshold is not above";
  EXPECT_EQ(BoostedStumps{}.margin({}), 0.0);
}

TEST(AdaBoost, WrongExamplesAreRefusedByName) {
  const auto complaint = [](const std::function<void(LabeledFeatures&)>& change) -> std::string {
    LabeledFeatures training{.names = {"x", "y"}, .examples = {{0, 0}, {1, 1}}, .labels = {1, -1}};
    change(training);
    try {
      train_adaboost(training, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint([](auto& t) { t.labels.pop_back(); }),
            "adaboost: 2 examples and 1 labels: numbers must be equal");
  EXPECT_EQ(complaint([](auto& t) { t.examples[1] = {1.0}; }), "adaboost: example 1: 1 features: must be 2");
  EXPECT_EQ(complaint([](auto& t) { t.examples[1][1] = std::nan(""); }),
            "adaboost: example 1: y = nan: must be finite");
  EXPECT_EQ(complaint([](auto& t) { t.labels[0] = 0; }), "adaboost: example 0: label = 0: must be +1 or -1");
  EXPECT_EQ(complaint([](auto& t) { t.labels[0] = -1; }), "adaboost: no example has label 1: both labels are required");
  EXPECT_EQ(complaint([](auto& t) { t = {.names = {"x"}, .examples = {}, .labels = {}}; }),
            "adaboost: no example has label 1: both labels are required");
}

}  // namespace
}  // namespace patrol::slam::adaboost_test
