#include "slam/submaps/pair_features.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "slam/submaps/adaboost.h"
#include "tests/support/observed_submap.h"
#include "tests/support/submap_points.h"

namespace patrol::slam::pair_features_test {
namespace {

using test::make_yard, test::RoomWorld, test::see_submap, test::SeenSubmap, test::short_walk;
using Points = std::vector<Eigen::Vector2d>;

constexpr double kExactTol = 1e-9;  // algebra, some of it through a histogram

std::vector<double> pair_features(const SubmapDescriptor& target, const SubmapDescriptor& source,
                                  const PoseGaussian& T_target_source, const NdtSettings& settings) {
  return compare_submaps(target, source, T_target_source, settings).features;
}

double value(const std::vector<double>& features, const std::string& name) {
  const auto found = std::ranges::find(kPairFeatures, name);
  EXPECT_NE(found, kPairFeatures.end()) << name;
  return features[static_cast<std::size_t>(found - kPairFeatures.begin())];
}

/// A square's outline of side 2 m about the origin, 80 points.
Points square_outline() {
  RoomWorld box;
  box.add_box(-1.0, -1.0, 1.0, 1.0);
  return test::sample_walls(box, {});
}

SubmapDescriptor describe(const SeenSubmap& submap) { return describe_submap(submap.points, submap.map, {}); }

/// A submap of the yard from a short walk that starts at its frame.
SubmapDescriptor describe_yard(const Pose2& T_world_submap, std::uint64_t seed) {
  return describe(see_submap(make_yard(), T_world_submap, short_walk(T_world_submap), seed));
}

PoseGaussian prediction_of(const Pose2& T_target_source, double std_m, double std_rad) {
  return {.mean = T_target_source,
          .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

/// Two submaps of the yard, 4 m apart, that see about the same.
const Pose2 kTarget{-7.0, -4.0, 0.6}, kSource{-4.0, -5.0, 1.1};
const Pose2 kTruth = kTarget.inverse() * kSource;

TEST(PairFeatures, HaveFourteenNamesNoneTwice) {
  const std::vector<std::string> names = pair_feature_names();
  EXPECT_EQ(names.size(), 14U);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 14U);
}

// Two squares of side 2, one 1 m to the side: radius of the outline sqrt(1 + 1/3).
TEST(PairFeatures, OfTwoSquaresEqualTheirGeometry) {
  const SubmapDescriptor square = describe_submap(square_outline(), GridMap(0.05, 100.0), {});
  const double radius = std::sqrt(4.0 / 3.0);
  ASSERT_NEAR(square.radius_m, radius, 0.01) << "of 80 points";
  const auto features = pair_features(square, square, prediction_of({1.0, 0.0, 0.0}, 0.25, 0.05), {});
  EXPECT_NEAR(value(features, "center_distance"), 1.0 / (2.0 * square.radius_m), kExactTol);
  EXPECT_NEAR(value(features, "center_mahalanobis"), 4.0, 1e-6);
  EXPECT_NEAR(value(features, "center_std"), 0.25 / (2.0 * square.radius_m), kExactTol);
  EXPECT_NEAR(value(features, "hull_overlap"), 0.5, 0.01);
  EXPECT_NEAR(value(features, "distance_difference"), 0.0, kExactTol);
  EXPECT_NEAR(value(features, "direction_correlation"), 1.0, kExactTol);
  EXPECT_NEAR(value(features, "direction_predicted"), 1.0, kExactTol);
  EXPECT_EQ(value(features, "point_ratio"), 1.0);
  EXPECT_EQ(value(features, "radius_ratio"), 1.0);
  EXPECT_EQ(value(features, "seen_overlap"), 0.0) << "nothing was seen";
  EXPECT_EQ(value(features, "aligned_agreement"), 0.0);
  // NDT lays the squares on each other, 4 standard deviations away.
  EXPECT_NEAR(value(features, "aligned_mahalanobis"), 4.0, 0.05);
}

// A heading's error moves what is far from the frame's origin: 10 m times 0.1 rad.
TEST(PairFeatures, TheCenterIsAsUncertainAsItsArmIsLong) {
  Points far = square_outline();
  for (auto& p : far) p.x() += 10.0;
  const SubmapDescriptor near = describe_submap(square_outline(), GridMap(0.05, 100.0), {}),
                         away = describe_submap(far, GridMap(0.05, 100.0), {});
  const auto features = pair_features(near, away, prediction_of({-10.0, 0.0, 0.0}, 0.0, 0.1), {});
  EXPECT_NEAR(value(features, "center_std"), (away.center.norm() * 0.1) / (near.radius_m + away.radius_m), kExactTol);
}

TEST(PairFeatures, OfNeighborsIndicateNeighbors) {
  const SubmapDescriptor target = describe_yard(kTarget, 1), source = describe_yard(kSource, 2);
  const auto features = pair_features(
      target, source, prediction_of({kTruth.x + 0.8, kTruth.y - 0.6, kTruth.yaw + 5.0 * kDegree}, 0.7, 4.0 * kDegree),
      {});
  EXPECT_GT(value(features, "hull_overlap"), 0.8);
  EXPECT_GT(value(features, "seen_overlap"), 0.6)
      << "through the gate and between posts each sees what the other does not";
  EXPECT_LT(value(features, "aligned_mahalanobis"), 3.0)
      << "0.8 and 0.6 m off, 0.7 m of standard deviation; 1.25 of the angle's";
  EXPECT_GT(value(features, "aligned_mahalanobis"), 1.0);
  EXPECT_GT(value(features, "aligned_agreement"), 0.9);
  EXPECT_GT(value(features, "score_aligned"), 0.4);
}

// The same prediction of another place: a hall with pillars.
TEST(PairFeatures, OfNonNeighborsIndicateNonNeighbors) {
  RoomWorld hall;
  hall.add_box(-14.0, -9.0, 5.0, 3.0);
  for (int i = -3; i <= 0; ++i) hall.add_post(4.0 * i + 1.0, -2.0, 0.4).add_post(4.0 * i + 1.0, -7.5, 0.4);
  const SubmapDescriptor target = describe_yard(kTarget, 1),
                         source = describe(see_submap(hall, kSource, short_walk(kSource), 2));
  const auto features = pair_features(target, source, prediction_of(kTruth, 0.7, 4.0 * kDegree), {});
  EXPECT_GT(value(features, "hull_overlap"), 0.5) << "by the prediction alone they would be neighbors";
  EXPECT_LT(value(features, "aligned_agreement"), 0.7);
}

// A room of 10 m, and the same with a wall of 4 m, 2 m before the lidar, that hides one side: of 30 + 4 m that the
// second sees the first says that 4 are free. All 30 of the first that the second can judge agree; the smaller one
// counts.
TEST(PairFeatures, AgreementIsThatOfTheOneWhoDisagrees) {
  RoomWorld room, divided;
  room.add_box(-5.02, -5.02, 5.02, 5.02);  // in the middle of cells: with 1 cm of noise one row of them is a wall
  divided.add(room).add_wall(2.02, -2.02, 2.02, 2.02);
  const std::vector<Pose2> still(3);
  const SubmapDescriptor before = describe(see_submap(room, {}, still, 1)),
                         after = describe(see_submap(divided, {}, still, 2));
  const PoseGaussian prediction = prediction_of({0.1, 0.1, 0.01}, 0.1, 0.01);
  EXPECT_NEAR(value(pair_features(before, after, prediction, {}), "aligned_agreement"), 30.0 / 34.0, 0.03);
  EXPECT_NEAR(value(pair_features(after, before, prediction, {}), "aligned_agreement"), 30.0 / 34.0, 0.03);
  EXPECT_GT(value(pair_features(before, before, prediction, {}), "aligned_agreement"), 0.99);
}

TEST(PairFeatures, FourNeedNoPose) {
  const SubmapDescriptor target = describe_yard(kTarget, 1), source = describe_yard(kSource, 2);
  const auto here = pair_features(target, source, prediction_of(kTruth, 0.1, 0.01), {});
  const auto there = pair_features(target, source, prediction_of({70.0, -9.0, 2.0}, 5.0, 1.0), {});
  const auto swapped = pair_features(source, target, prediction_of({}, 1.0, 1.0), {});
  for (const char* name : {"distance_difference", "direction_correlation", "point_ratio", "radius_ratio"}) {
    EXPECT_EQ(value(here, name), value(there, name)) << name;
    EXPECT_NEAR(value(here, name), value(swapped, name), kExactTol) << name;
  }
}

// The source's frame lies elsewhere in it: 7 m away, turned by 35 degrees. What is computed from points is the same;
// maps are drawn anew on other cells.
TEST(PairFeatures, DoNotDependOnTheFrameOfASubmap) {
  const Pose2 T_source_other{5.0, -5.0, 35.0 * kDegree};
  const SubmapDescriptor target = describe_yard(kTarget, 1), source = describe_yard(kSource, 2);
  const SubmapDescriptor other = describe(see_submap(make_yard(), kSource * T_source_other, short_walk(kSource), 2));
  // The same place of the center must be as uncertain, whatever the arm: no error of heading.
  const auto features = pair_features(target, source, prediction_of(kTruth, 0.5, 0.0), {});
  const auto others = pair_features(target, other, prediction_of(kTruth * T_source_other, 0.5, 0.0), {});
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::string name = kPairFeatures[i];
    if (name == "aligned_mahalanobis") continue;  // any heading but the predicted one is impossible here
    EXPECT_NEAR(features[i], others[i], 0.05 * std::max(1.0, std::abs(features[i]))) << name;
  }
}

TEST(PairFeatures, TwiceAsLargeIsTheSame) {
  Points twice = square_outline();
  for (auto& p : twice) p *= 2.0;
  const SubmapDescriptor small = describe_submap(square_outline(), GridMap(0.05, 100.0), {}),
                         large = describe_submap(twice, GridMap(0.05, 100.0), {});
  const auto of_small = pair_features(small, small, prediction_of({0.7, 0.2, 0.3}, 0.2, 0.05), {});
  const auto of_large = pair_features(large, large, prediction_of({1.4, 0.4, 0.3}, 0.4, 0.05), {});
  for (const char* name :
       {"center_distance", "center_mahalanobis", "center_std", "hull_overlap", "radius_ratio", "point_ratio"}) {
    EXPECT_NEAR(value(of_small, name), value(of_large, name), 1e-6) << name;
  }
}

TEST(PairFeatures, AreFiniteWhateverTheSubmaps) {
  const GridMap nothing(0.05, 100.0);
  const SubmapDescriptor line = describe_submap({{0, 0}, {1, 1}, {2, 2}}, nothing, {}),
                         spot = describe_submap({{1, 1}, {1, 1}, {1, 1}}, nothing, {});
  for (const PoseGaussian& prediction : {prediction_of({}, 0.0, 0.0), prediction_of({1e6, -1e6, 3.0}, 1e6, 100.0)}) {
    for (const auto& [target, source] : {std::pair(&line, &spot), {&spot, &line}, {&spot, &spot}}) {
      const auto features = pair_features(*target, *source, prediction, {});
      for (std::size_t i = 0; i < features.size(); ++i) EXPECT_TRUE(std::isfinite(features[i])) << kPairFeatures[i];
    }
  }
}

/// A site of huts, walls and posts, 60 m each way, as the seed has it.
RoomWorld make_site(std::uint64_t seed) {
  const RandomStream random(seed, "test/site");
  RoomWorld site;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto u = random.uniforms(i);
    const double x = 60.0 * u[0] - 30.0, y = 60.0 * u[1] - 30.0, w = 1.0 + 4.0 * u[2], h = 1.0 + 4.0 * u[3];
    if (i % 3 == 0) site.add_box(x, y, x + w, y + h);
    if (i % 3 == 1) site.add_wall(x, y, x + (i % 2 == 0 ? 2.0 * w : 0.0), y + (i % 2 == 0 ? 0.0 : 2.0 * h));
    if (i % 3 == 2) site.add_post(x, y, 0.2);
  }
  return site;
}

/// Pairs of submaps of a site, half of them neighbors; predictions are off by 1 m and 5 degrees (one standard
/// deviation) and say all the same of strangers.
LabeledFeatures make_pairs(std::uint64_t seed, int num_pairs) {
  const RoomWorld site = make_site(seed);
  const RandomStream random(seed, "test/pairs");
  LabeledFeatures pairs{.names = pair_feature_names(), .examples = {}, .labels = {}};
  for (int i = 0; i < num_pairs; ++i) {
    const auto tick = static_cast<std::uint64_t>(i);
    const auto u = random.uniforms(tick), v = random.uniforms(tick, 1), error = random.normals(tick, 2);
    const Pose2 T_world_target{30.0 * u[0] - 15.0, 30.0 * u[1] - 15.0, 6.28 * u[2]};
    const Pose2 T_target_source{12.0 * v[0] - 6.0, 12.0 * v[1] - 6.0, 6.28 * v[2]};
    const bool are_neighbors = i % 2 == 0;
    const Pose2 T_world_source =
        are_neighbors ? T_world_target * T_target_source : Pose2{-T_world_target.x, -T_world_target.y, 6.28 * u[3]};
    const SubmapDescriptor target = describe(see_submap(site, T_world_target, short_walk(T_world_target), 2 * tick)),
                           source =
                               describe(see_submap(site, T_world_source, short_walk(T_world_source), 2 * tick + 1));
    if (!are_neighbors && (T_world_target.position() - T_world_source.position()).norm() < 12.0) continue;
    const Pose2 predicted{T_target_source.x + error[0], T_target_source.y + error[1],
                          wrap_angle(T_target_source.yaw + 5.0 * kDegree * error[2])};
    pairs.examples.push_back(pair_features(target, source, prediction_of(predicted, 1.0, 5.0 * kDegree), {}));
    pairs.labels.push_back(are_neighbors ? 1 : -1);
  }
  return pairs;
}

TEST(PairFeatures, AdaBoostSeparatesNeighborsFromNonNeighborsOnANewSite) {
  const LabeledFeatures training = make_pairs(1, 80), test = make_pairs(2, 80);
  const BoostingResult result = train_adaboost(training, {.rounds = 20});
  int missed = 0, mistaken = 0;
  for (std::size_t i = 0; i < test.examples.size(); ++i) {
    const bool says_yes = result.model.margin(test.examples[i]) > 0.0;
    missed += !says_yes && test.labels[i] > 0 ? 1 : 0;
    mistaken += says_yes && test.labels[i] < 0 ? 1 : 0;
  }
  EXPECT_LE(missed, 4) << "of 40 neighbors";
  EXPECT_LE(mistaken, 2) << "of " << std::ranges::count(test.labels, -1) << " strangers";
  RecordProperty("missed", missed);
  RecordProperty("mistaken", mistaken);
  RecordProperty("strangers", static_cast<int>(std::ranges::count(test.labels, -1)));
  RecordProperty("stumps", static_cast<int>(result.model.stumps.size()));
}

}  // namespace
}  // namespace patrol::slam::pair_features_test
