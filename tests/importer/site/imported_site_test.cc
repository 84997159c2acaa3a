#include "importer/site/imported_site.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::imported_site_test {
namespace {

TEST(ImportedSite, AnInterruptedSiteLeavesNoFolder) {
  const ImportedSite site{.name = "site",
                          .source = "test",
                          .materials = {{.name = "floor"}},
                          .shapes = {{.name = "floor", .type = SiteShapeType::kPlane, .material = "floor"}}};
  const test::TemporaryFolder folder;
  EXPECT_FALSE(write_site(site, folder / "site", [] { return true; }));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_TRUE(write_site(site, folder / "site", [] { return false; }));
  EXPECT_TRUE(std::filesystem::exists(folder / "site/site.xml"));
}

TEST(ImportedSite, RowsAboutTheCompiledSiteAreReturnedAndWrittenBehindTheOtherOnes) {
  const ImportedSite site{.name = "site",
                          .source = "test",
                          .materials = {{.name = "floor"}},
                          .shapes = {{.name = "crate", .size_m = {0.5, 0.5, 1.0}, .material = "floor"}},
                          .assumptions = {{"up", "z", "--up"}}};
  const test::TemporaryFolder folder;
  const std::optional<std::vector<Assumption>> rows = write_site(site, folder / "site");
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 2u);
  EXPECT_EQ(rows->at(0).subject, "up");
  EXPECT_EQ(rows->at(1).subject, "no ground");
  EXPECT_THAT(test::read_bytes(folder / "site/README.md"), ::testing::HasSubstr("| no ground | no plane"));
}

TEST(ImportedSite, ASiteFartherThan100kmIsRefusedAndNothingIsWritten) {
  SiteShape far{.name = "room.link.wall", .size_m = {0.5, 0.5, 1.0}, .material = "floor"};
  far.T_site_shape.position << 450012.5, 5412345.25, 32.0;
  const ImportedSite site{.name = "site", .source = "room.world", .materials = {{.name = "floor"}}, .shapes = {far}};
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { write_site(site, folder / "site"); },
              ::testing::ThrowsMessage<InputError>(
                  ::testing::StartsWith("room.world: room.link.wall: coordinates up to 5.41e+06 m: must be at most")));
  EXPECT_THROW(compile_site(site), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace patrol::importer::imported_site_test
