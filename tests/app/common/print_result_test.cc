#include "app/common/print_result.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::app::print_result_test {
namespace {

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
