#include "app/scoring/score_json.h"

#include <cmath>

#include <gtest/gtest.h>

#include "app/scoring/score_run.h"

namespace patrol::app::score_json_test {
namespace {

TEST(ScoreJson, OfAnEmptyMapHasACoverageOfZeroAndNoDistances) {
  const io::Metrics empty = to_json(score::MapError{});
  EXPECT_EQ(empty.at("coverage"), 0.0);
  EXPECT_TRUE(empty.at("nearest_mean_m").is_null());
  score::MapError error;
  error.num_occupied = 1;
  error.nearest_mean_m = 0.02;
  EXPECT_EQ(to_json(error).at("nearest_mean_m"), 0.02);
}

TEST(ScoreJson, OfPoseNeesWithoutARegularCovarianceIsNull) {
  score::PoseNees nees;
  nees.num_instants = nees.num_singular = 4;
  const io::Metrics singular = to_json(nees);
  EXPECT_TRUE(singular.at("mean").is_null());
  EXPECT_TRUE(singular.at("per_dimension").is_null());
  EXPECT_EQ(singular.at("within_95"), 0.0);
  EXPECT_EQ(singular.at("instants"), 4);
  EXPECT_EQ(singular.at("singular"), 4);
  nees.num_singular = 1;
  nees.mean = 6.0;
  EXPECT_EQ(to_json(nees).at("per_dimension"), 2.0);
}

/// Circle around (5, 5) at 1 m/s, ten poses per second, from one time to another.
Trajectory drive(double from_s, double to_s) {
  Trajectory trajectory;
  for (int i = 0; 0.1 * i <= to_s - from_s + 1e-9; ++i) {
    const double time_s = from_s + 0.1 * i;
    trajectory.push_back(
        {from_seconds(time_s), to_pose3({5.0 + std::cos(time_s), 5.0 + std::sin(time_s), 0.1 * time_s})});
  }
  return trajectory;
}

TEST(ScoreTrajectories, TellsHowMuchOfTheReferenceAShortEstimateCovers) {
  const io::Metrics metrics = score_trajectories(drive(2.0, 6.0), drive(0.0, 10.0));
  EXPECT_NEAR(metrics.at("pose").at("ate_max_m").get<double>(), 0.0, 1e-9);
  EXPECT_EQ(metrics.at("pose").at("poses"), 41);
  EXPECT_EQ(metrics.at("pose").at("left_out"), 0);
  EXPECT_NEAR(metrics.at("pose").at("coverage").get<double>(), 0.44, 1e-9);
}

TEST(ScoreTrajectories, CountsPosesInHolesOfTheReference) {
  Trajectory reference = drive(0.0, 10.0);
  std::erase_if(reference, [](const StampedPose& e) { return e.stamp > from_seconds(4) && e.stamp < from_seconds(6); });
  const io::Metrics pose = score_trajectories(drive(0.0, 10.0), reference).at("pose");
  EXPECT_EQ(pose.at("left_out"), 19);
  EXPECT_NEAR(pose.at("ate_max_m").get<double>(), 0.0, 1e-9);
}

TEST(ScoreTrajectories, WithoutAUniqueAlignmentGivesTheErrorsInTheFrameOfTheStart) {
  const Trajectory still = {{from_seconds(0), {}}, {from_seconds(1), {}}, {from_seconds(2), {}}};
  const io::Metrics pose = score_trajectories(still, still).at("pose");
  EXPECT_EQ(pose.at("ate_rmse_m"), 0.0);
  EXPECT_TRUE(pose.at("aligned").is_null());
  EXPECT_NE(pose.at("not_aligned").get<std::string>().find("no unique alignment"), std::string::npos);
}

}  // namespace
}  // namespace patrol::app::score_json_test
