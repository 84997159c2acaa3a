#include "app/scoring/metric_infos.h"

#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/scoring/score_json.h"
#include "core/error.h"

namespace patrol::app::metric_infos_test {
namespace {

TEST(MetricInfos, EachPathIsListedOnceWithANounPhraseOfThreeWordsOrMore) {
  std::set<std::string> paths;
  for (const MetricInfo& info : metric_infos()) {
    EXPECT_TRUE(paths.insert(info.path).second) << info.path;
    std::istringstream words(info.summary);
    const std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
    EXPECT_GE(list.size(), 3u) << info.path << ": " << info.summary;
    EXPECT_FALSE(info.summary.ends_with('.')) << info.path << ": " << info.summary;
    EXPECT_EQ(info.summary.find("{}"), std::string::npos) << info.path << ": " << info.summary;
  }
}

TEST(MetricInfos, EntryOfAPathIsFoundAndAnUnknownPathHasNone) {
  EXPECT_EQ(find_metric_info("pose.ate_rmse_m").value().path, "pose.ate_rmse_m");
  EXPECT_EQ(find_metric_info("goals.goal_1.position_error_m.mean").value().path, "goals.*.position_error_m.mean");
  EXPECT_FALSE(find_metric_info("pose.ate_rmse"));
  EXPECT_FALSE(find_metric_info("posexate_rmse_m"));
  EXPECT_FALSE(find_metric_info(""));
}

TEST(CheckMetric, AnUnknownOneIsRefusedWithTheNearest) {
  EXPECT_NO_THROW(check_metric("", "goals.goal_1.position_error_m.mean"));
  try {
    check_metric("--metric mission.colisions: ", "mission.colisions");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--metric mission.colisions: unknown metric; did you mean mission.collisions? ('patrol list metrics' "
                 "shows all)");
  }
}

/// Paths of all values, entries of lists by index.
void add_paths(const io::Metrics& value, const std::string& path, std::vector<std::string>& paths) {
  if (!value.is_structured()) {
    paths.push_back(path);
    return;
  }
  for (const auto& [key, child] : value.items()) {
    if (key != "name") add_paths(child, path.empty() ? key : path + "." + key, paths);
  }
}

/// Score of a run that has all parts.
score::RunScore full_score() {
  score::RunScore score;
  score::EstimateScore& estimate = score.estimate.emplace();
  estimate.aligned_pose.emplace();
  estimate.stations.emplace_back();
  estimate.calibration.emplace_back().name = "lidar/yaw_rad";
  estimate.goals.emplace_back();
  estimate.docking.emplace();
  estimate.range_pose.emplace();
  estimate.known_map.emplace().kidnaps.emplace_back();
  estimate.lining.emplace().rings.emplace_back();
  estimate.water.emplace();
  return score;
}

TEST(MetricInfos, EveryMetricOfARunWithAllPartsHasAnEntry) {
  std::vector<std::string> paths;
  add_paths(to_json(full_score()), "", paths);
  EXPECT_GE(paths.size(), 100u);
  for (const std::string& path : paths) EXPECT_TRUE(find_metric_info(path)) << path;
}

}  // namespace
}  // namespace patrol::app::metric_infos_test
