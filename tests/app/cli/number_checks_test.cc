#include "app/cli/number_checks.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cli/command_line.h"

namespace patrol::app::number_checks_test {
namespace {

using ::testing::HasSubstr;

/// Runs a command that must be refused with exit code 2; returns standard error.
std::string refusal(std::vector<const char*> words) {
  words.insert(words.begin(), "patrol");
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_command_line(static_cast<int>(words.size()), words.data()), 2);
  return testing::internal::GetCapturedStderr();
}

TEST(NumberChecks, OptionsWithARangeRefuseNanInOneLine) {
  for (const char* option : {"--wall-height", "--contact-cell", "--scale"}) {
    const std::string text = refusal({"import", "site", "a.yaml", "--out", "no/such/folder", option, "nan"});
    EXPECT_THAT(text, HasSubstr(option));
    EXPECT_THAT(text, HasSubstr("nan: must be a number"));
    EXPECT_EQ(text.find('\n'), text.size() - 1);
  }
}

TEST(NumberChecks, AScaleOf0IsRefusedWithoutABoundOf300Digits) {
  EXPECT_EQ(refusal({"import", "site", "a.yaml", "--out", "no/such/folder", "--scale", "0"}),
            "patrol: --scale: 0: must be above 0\n");
}

}  // namespace
}  // namespace patrol::app::number_checks_test
