#include "app/campaign/test/seed_table.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::seed_table_test {
namespace {

SeedTable table_of(const std::string& text) { return SeedTable(test::TemporaryFile("seeds.json", text).path()); }

TEST(SeedTable, AKeyIsTheEndOfAPathInWholeNames) {
  const SeedTable table = table_of(R"({"scenarios/a.yaml": 3, "tunnel/scenarios/a.yaml": 4})");
  EXPECT_EQ(table.seed_of("/x/street/scenarios/a.yaml"), 3u);
  EXPECT_EQ(table.seed_of("/x/tunnel/scenarios/../scenarios/a.yaml"), 4u);
  EXPECT_EQ(table.seed_of("/x/street/old_scenarios/a.yaml"), std::nullopt);
  EXPECT_EQ(table.seed_of("/x/street/scenarios/b.yaml"), std::nullopt);
  EXPECT_EQ(SeedTable().seed_of("/x/scenarios/a.yaml"), std::nullopt);
}

TEST(SeedTable, RefusesWhatIsNoTable) {
  for (const char* text : {"", "[]", R"({"a.yaml": -1})", R"({"a.yaml": 1.5})", R"({"a.yaml": "1"})"})
    EXPECT_THROW(table_of(text), InputError) << text;
  EXPECT_THROW(SeedTable{"/nowhere.json"}, InputError);
}

}  // namespace
}  // namespace patrol::app::seed_table_test
