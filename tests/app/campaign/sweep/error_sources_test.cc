#include "app/campaign/sweep/error_sources.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace patrol::app::error_sources_test {
namespace {

TEST(ErrorSources, NamesAreUnique) {
  std::set<std::string> names;
  for (const ScenarioErrorSource& source : scenario_error_sources()) {
    EXPECT_TRUE(names.insert(source.name).second) << source.name;
  }
}

/// Each tolerance of section `as_built` is a source, which applies only to as-built robots.
TEST(ErrorSources, EveryAsBuiltToleranceIsOneSource) {
  Scenario scenario;
  scenario.as_built.enabled = false;
  ScenarioFiles files;
  int num_tolerances = 0;
  for (const ScenarioErrorSource& source : scenario_error_sources()) {
    if (!source.name.starts_with("as built: ")) continue;
    ++num_tolerances;
    ASSERT_EQ(source.overrides.size(), 1U);
    EXPECT_EQ(source.overrides[0], "as_built." + source.name.substr(10) + "=0");
    EXPECT_FALSE(source.applies(scenario, files)) << source.name;
  }
  EXPECT_GT(num_tolerances, 25);
  scenario.as_built.enabled = true;
  const auto& all = scenario_error_sources();
  const auto applies = [&](const std::string& name) {
    const auto source = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    return source != all.end() && source->applies(scenario, files);
  };
  EXPECT_TRUE(applies("as built: mounting.angle_deg"));
  EXPECT_TRUE(applies("as built: lidar.cone_deg"));
  EXPECT_FALSE(applies("as built: tracks.gauge_m")) << "a robot without tracks";
  EXPECT_FALSE(applies("as built: uwb.tag_delay_m")) << "UWB is off by default";
  EXPECT_FALSE(applies("as built: lidar.noise_ratio"));
  files.robot.tracks = TrackGeometry{};
  EXPECT_TRUE(applies("as built: tracks.gauge_m"));
}

}  // namespace
}  // namespace patrol::app::error_sources_test
