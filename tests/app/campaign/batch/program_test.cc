#include "app/campaign/batch/program.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace patrol::app::program_test {
namespace {

TEST(Program, SaysItsOutputAndExitStatus) {
  const ProgramResult result = run_program({"sh", "-c", "echo hello; exit 3"});
  EXPECT_EQ(result.output, "hello\n");
  EXPECT_EQ(result.exit_code, 3);
}

TEST(Program, AQuotedWordComesBackFromTheShell) {
  const std::string word = "it's \"$HOME\" `a` \\ b";
  EXPECT_EQ(run_program({"sh", "-c", "printf %s " + quote_for_shell(word)}).output, word);
}

TEST(Program, OneThatThereIsNotIsAnError) { EXPECT_THROW(run_program({"patrol-no-such-program"}), std::runtime_error); }

}  // namespace
}  // namespace patrol::app::program_test
