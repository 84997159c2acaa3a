#include "app/film/shared_progress.h"

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace patrol::app::shared_progress_test {
namespace {

TEST(SharedProgress, IsTheMeanOfThePartsOfAllProcesses) {
  SharedProgress progress(2);
  EXPECT_EQ(progress.mean(), 0.0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    progress.set(1, 0.5);
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(progress.mean(), 0.25);
  progress.set(0, 1.0);
  EXPECT_EQ(progress.mean(), 0.75);
}

}  // namespace
}  // namespace patrol::app::shared_progress_test
