#include "app/realism/log_on_site.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::log_on_site_test {
namespace {

TEST(LogOnSite, TheSiteOfTheOptionReplacesTheWorldOfARunThatIsNotHere) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run");
  test::write_bytes(folder / "run/scenario.yaml", "world: elsewhere\nrobot: wheeled\nmission: routes/patrol.json\n");
  test::write_bytes(folder / "run/log.mcap", "log");
  test::write_bytes(folder / "path.tum", "1 0 0 0.3 0 0 0 1\n2 1 0 0.3 0 0 0 1\n");
  test::write_bytes(folder / "site.xml", "<mujoco/>");
  LogOnSiteOptions options{
      .log = folder / "run", .site = {}, .trajectory = (folder / "path.tum").string(), .lidar = {}};
  EXPECT_THAT([&] { find_log_on_site(options, {}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("elsewhere")));
  options.site = (folder / "site.xml").string();
  const LogOnSite found = find_log_on_site(options, {});
  EXPECT_EQ(found.world_xml, folder / "site.xml");
  EXPECT_EQ(found.log, folder / "run/log.mcap");
  EXPECT_TRUE(found.is_run);
  EXPECT_EQ(found.T_site_body.size(), 2u);
}

TEST(LogOnSite, APathOfARunWithoutHeightsHasTheMeanHeightOfTheGroundTruth) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run");
  test::write_bytes(folder / "run/scenario.yaml", "world: street\nrobot: wheeled\nmission: routes/patrol.json\n");
  io::RunLogWriter log(folder / "run/log.mcap", io::TransformSet{});
  for (const double z_m : {1.25, 1.75}) {
    GroundTruth truth;
    truth.stamp = from_seconds(z_m);
    truth.T_world_body.position.z() = z_m;
    log.write(truth.stamp, truth);
  }
  log.close();
  const auto heights = [&](const std::string& path) {
    test::write_bytes(folder / "path.tum", path);
    std::vector<double> z_m;
    const LogOnSiteOptions options{
        .log = folder / "run", .site = {}, .trajectory = (folder / "path.tum").string(), .lidar = {}};
    LogOnSiteSettings settings;
    settings.path.x_m = 4.0;
    for (const StampedPose& entry : find_log_on_site(options, settings).T_site_body) {
      EXPECT_EQ(entry.pose.position.x(), 5.0);
      z_m.push_back(entry.pose.position.z());
    }
    return z_m;
  };
  EXPECT_THAT(heights("1 1 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"), ::testing::ElementsAre(1.5, 1.5));
  EXPECT_THAT(heights("1 1 0 0 0 0 0 1\n2 1 0 0.1 0 0 0 1\n"), ::testing::ElementsAre(0.0, 0.1));
}

}  // namespace
}  // namespace patrol::app::log_on_site_test
