#include "app/realism/log_on_site.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::log_on_site_test {
namespace {

TEST(LogOnSite, TheSiteOfTheOptionReplacesTheWorldOfARunThatIsNotHere) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "run");
  test::write_bytes(folder / "run/scenario.yaml", "world: elsewhere\nrobot: wheeled\nmission: routes/patrol.json\n");
  test::write_bytes(folder / "run/log.mcap", "log");
  test::write_bytes(folder / "path.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
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

}  // namespace
}  // namespace patrol::app::log_on_site_test
