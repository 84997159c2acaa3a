#include "io/json/metrics_json.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::metrics_json_test {
namespace {

Metrics make_metrics() {
  return Metrics::parse(
      R"({"pose": {"ate_rmse_m": 0.05, "note": "text", "none": null}, "mission": {"completed": true, "fell": false},
    "stations": [{"name": "box_1", "map_error_m": 0.1}, {"name": "box_2", "map_error_m": 0.2}]})");
}

TEST(MetricAt, FollowsThePathThroughSectionsAndLists) {
  const Metrics metrics = make_metrics();
  EXPECT_EQ(metric_at(metrics, "pose.ate_rmse_m"), 0.05);
  EXPECT_EQ(metric_at(metrics, "stations.1.map_error_m"), 0.2);
  EXPECT_EQ(metric_at(metrics, "stations.box_1.map_error_m"), 0.1);
}

TEST(MetricAt, TruthsCountAsOneAndZero) {
  EXPECT_EQ(metric_at(make_metrics(), "mission.completed"), 1.0);
  EXPECT_EQ(metric_at(make_metrics(), "mission.fell"), 0.0);
}

TEST(MetricAt, WhatIsNoFigureIsNone) {
  const Metrics metrics = make_metrics();
  for (const char* path : {"", "pose", "pose.", "pose.ate", "pose.note", "pose.none", "pose.ate_rmse_m.x", "stations",
                           "stations.2.map_error_m", "stations.-1.map_error_m", "stations.box_3.map_error_m"}) {
    EXPECT_FALSE(metric_at(metrics, path)) << path;
  }
}

TEST(MetricAt, NotANumberIsNoFigure) {
  EXPECT_FALSE(metric_at({{"x", std::numeric_limits<double>::quiet_NaN()}}, "x"));
  EXPECT_FALSE(metric_at({{"x", std::numeric_limits<double>::infinity()}}, "x"));
}

TEST(SaveMetrics, ThereAndBackKeepsOrderAndEveryDigit) {
  const test::TemporaryFolder folder;
  Metrics metrics;
  metrics["z"] = 0.1 + 0.2;
  metrics["a"]["wall_s"] = 1e-17;
  save_metrics(folder / "metrics.json", metrics);
  const Metrics again = load_metrics(folder / "metrics.json");
  EXPECT_EQ(again, metrics);
  EXPECT_EQ(again.begin().key(), "z");
  EXPECT_EQ(metric_at(again, "z"), 0.1 + 0.2);
}

TEST(SaveMetrics, NotANumberBecomesNull) {
  const test::TemporaryFolder folder;
  save_metrics(folder / "metrics.json", {{"x", std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(test::read_bytes(folder / "metrics.json"), "{\n  \"x\": null\n}\n");
}

TEST(FiguresOf, GoThroughTheTreeAndNameEntriesOfLists) {
  const Metrics metrics = {{"mission", {{"completed", true}, {"note", "word"}}},
                           {"stations", {{{"name", "box"}, {"error_m", 0.5}}, {{"error_m", 0.25}}}},
                           {"list", {1, nullptr}}};
  const std::vector<std::pair<std::string, double>> expected = {
      {"mission.completed", 1.0}, {"stations.box.error_m", 0.5}, {"stations.1.error_m", 0.25}, {"list.0", 1.0}};
  EXPECT_EQ(flatten_metrics(metrics), expected);
}

TEST(LoadMetrics, BrokenAndMissingFilesAreNamed) {
  const test::TemporaryFile file("metrics.json", "{\"a\": ");
  try {
    load_metrics(file.path());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), file.path() + ": is not JSON at byte 7");
  }
  EXPECT_THROW(load_metrics("/nowhere/metrics.json"), InputError);
}

}  // namespace
}  // namespace patrol::io::metrics_json_test
