#include "io/json/table_json.h"

#include <gtest/gtest.h>

namespace patrol::io::table_json_test {
namespace {

TEST(TableJson, TableBecomesAListOfObjectsWithNullForEmptyCells) {
  const Table table{.name = "runs",
                    .columns = {"seed", "error_m", "end"},
                    .rows = {{std::int64_t{1}, 0.5, std::string("done")}, {std::int64_t{2}, {}, {}}}};
  EXPECT_EQ(to_json(table).dump(), R"([{"seed":1,"error_m":0.5,"end":"done"},{"seed":2,"error_m":null,"end":null}])");
}

}  // namespace
}  // namespace patrol::io::table_json_test
