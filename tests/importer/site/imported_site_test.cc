#include "importer/site/imported_site.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace patrol::importer::imported_site_test
