#include "app/cli/command_line.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

namespace patrol::app::command_line_test {
namespace {

void run_version_then_fail_in_mujoco() {
  const char* const words[] = {"patrol", "--version"};
  run_command_line(2, words);
  mju_error("unexpected geom type %d", 22004);
}

TEST(CommandLine, AnErrorOfMujocoIsOneLineAndExitCodeThree) {
  EXPECT_EXIT(run_version_then_fail_in_mujoco(), testing::ExitedWithCode(3),
              "^patrol: mujoco: unexpected geom type 22004\n$");
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

}  // namespace
}  // namespace patrol::app::command_line_test
