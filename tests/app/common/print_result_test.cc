#include "app/common/print_result.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::app::print_result_test {
namespace {

TEST(PrintResult, TableBecomesAListOfObjectsWithNullForEmptyCells) {
  const io::Table table{.name = "runs",
                        .columns = {"seed", "error_m", "end"},
                        .rows = {{std::int64_t{1}, 0.5, std::string("done")}, {std::int64_t{2}, {}, {}}}};
  EXPECT_EQ(to_json(table).dump(), R"([{"seed":1,"error_m":0.5,"end":"done"},{"seed":2,"error_m":null,"end":null}])");
}

TEST(PrintResult, PrintsTheFormThatIsAskedFor) {
  ::testing::internal::CaptureStdout();
  print_result(ResultForm::kText, "text\n", {{"key", 1}});
  std::fflush(stdout);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "text\n");
  ::testing::internal::CaptureStdout();
  print_result(ResultForm::kJson, "text\n", {{"key", std::nan("")}});
  std::fflush(stdout);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "{\n  \"key\": null\n}\n");
}

}  // namespace
}  // namespace patrol::app::print_result_test
