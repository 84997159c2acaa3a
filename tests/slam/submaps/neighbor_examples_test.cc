#include "slam/submaps/neighbor_examples.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "slam/submaps/pair_features.h"
#include "tests/slam/submaps/submap_drive.h"

namespace patrol::slam::neighbor_examples_test {
namespace {

const test::SubmapDrive& office_drive() {
  static const test::SubmapDrive kDrive = test::map_by_submaps(test::make_office(), test::office_rounds(1), {}, {}, {});
  return kDrive;
}

LabeledFeatures examples_of(const test::SubmapDrive& drive, const NeighborExampleSettings& settings) {
  LabeledFeatures examples{.names = pair_feature_names(), .examples = {}, .labels = {}};
  add_neighbor_examples(drive.slam, drive.T_world_submap(), SubmapRbpfSettings{}.surfaces, settings, 1, examples);
  return examples;
}

TEST(NeighborExamples, AreOfBothKindsAndFinite) {
  const LabeledFeatures examples = examples_of(office_drive(), {});
  ASSERT_EQ(examples.examples.size(), examples.labels.size());
  EXPECT_GT(std::ranges::count(examples.labels, 1), 10);
  EXPECT_GT(std::ranges::count(examples.labels, -1), 10);
  for (const std::vector<double>& features : examples.examples) {
    ASSERT_EQ(features.size(), kPairFeatures.size());
    EXPECT_TRUE(std::ranges::all_of(features, [](double value) { return std::isfinite(value); }));
  }
}

TEST(NeighborExamples, AModelTrainedOnOneLapRecognizesNeighborsOnTheNextWithAPrecisionOf95Percent) {
  const BoostedStumps model = train_adaboost(examples_of(office_drive(), {}), {}).model;
  const test::SubmapDrive other = test::map_by_submaps(test::make_office(), test::office_rounds(1),
                                                       {.speed_mps = 0.8, .odometry_scale = -0.02}, {}, {}, 2);
  const LabeledFeatures trial = examples_of(other, {.predictions = 2});
  int right = 0, wrong = 0, missed = 0;
  for (std::size_t i = 0; i < trial.labels.size(); ++i) {
    const bool is_taken = model.margin(trial.examples[i]) > 0.2;
    right += is_taken && trial.labels[i] > 0 ? 1 : 0;
    wrong += is_taken && trial.labels[i] < 0 ? 1 : 0;
    missed += !is_taken && trial.labels[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(right, 19 * wrong);
  EXPECT_GT(right, missed);
}

TEST(NeighborExamples, TheSameSeedGivesTheSame) {
  EXPECT_EQ(examples_of(office_drive(), {.predictions = 1}).examples,
            examples_of(office_drive(), {.predictions = 1}).examples);
}

}  // namespace
}  // namespace patrol::slam::neighbor_examples_test
