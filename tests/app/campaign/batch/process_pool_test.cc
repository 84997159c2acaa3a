#include "app/campaign/batch/process_pool.h"

#include <dirent.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace patrol::app::process_pool_test {
namespace {

using std::chrono::milliseconds;

std::map<std::size_t, TaskEnd> run(std::size_t num_tasks, const ProcessPoolSettings& settings,
                                   const std::function<int(std::size_t)>& task) {
  std::map<std::size_t, TaskEnd> ends;
  EXPECT_TRUE(run_in_processes(
      num_tasks, settings, task, [&](const TaskEnd& end) { ends[end.task] = end; }, [] { return true; }));
  return ends;
}

int num_open_files() {
  int count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (::readdir(folder) != nullptr) ++count;
  ::closedir(folder);
  return count;
}

TEST(ProcessPool, EveryTaskEndsOnceWithItsExitStatus) {
  const auto ends = run(10, {.num_processes = 3}, [](std::size_t task) { return static_cast<int>(task); });
  ASSERT_EQ(ends.size(), 10u);
  for (const auto& [task, end] : ends) {
    EXPECT_EQ(end.exit_code, static_cast<int>(task));
    EXPECT_EQ(end.signal, 0);
  }
}

TEST(ProcessPool, ACrashIsOnesOwn) {
  const auto ends = run(3, {.num_processes = 2}, [](std::size_t task) {
    if (task == 1) {
      std::signal(SIGSEGV, SIG_DFL);  // sanitizers install a handler that exits
      std::raise(SIGSEGV);
    }
    return 0;
  });
  EXPECT_EQ(ends.at(1).signal, SIGSEGV);
  EXPECT_EQ(ends.at(0).signal, 0);
  EXPECT_EQ(ends.at(2).signal, 0);
}

TEST(ProcessPool, AnExceptionOfATaskEndsNoOtherTask) {
  const auto ends = run(3, {.num_processes = 3}, [](std::size_t task) {
    std::this_thread::sleep_for(milliseconds(task == 2 ? 100 : 600));
    if (task == 2) throw std::runtime_error("the world has no floor");
    return 0;
  });
  EXPECT_EQ(ends.at(0).signal, 0);
  EXPECT_EQ(ends.at(1).signal, 0);
  EXPECT_EQ(ends.at(2).signal, 0);
  EXPECT_EQ(ends.at(2).exit_code, 3);
  EXPECT_EQ(ends.at(2).last_stderr_line, "the world has no floor");
}

TEST(ProcessPool, AHangIsKilledAtItsLimit) {
  const auto ends = run(2, {.num_processes = 2, .timeout_s = 0.3}, [](std::size_t task) {
    if (task == 0) std::this_thread::sleep_for(milliseconds(60000));
    return 0;
  });
  EXPECT_TRUE(ends.at(0).is_over_time);
  EXPECT_FALSE(ends.at(1).is_over_time);
}

TEST(ProcessPool, LastWordsAreTheLastLineOfStandardError) {
  const auto ends = run(1, {}, [](std::size_t) {
    std::fprintf(stderr, "first\nthe world has no floor\n");
    std::abort();
    return 0;
  });
  EXPECT_EQ(ends.at(0).last_stderr_line, "the world has no floor");
  EXPECT_EQ(ends.at(0).signal, SIGABRT);
}

TEST(ProcessPool, TwoAtATimeTakeHalfTheTime) {
  const auto begin = std::chrono::steady_clock::now();
  run(4, {.num_processes = 2}, [](std::size_t) {
    std::this_thread::sleep_for(milliseconds(300));
    return 0;
  });
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GT(wall_s, 0.6);
  EXPECT_LT(wall_s, 1.1);
}

TEST(ProcessPool, WhenToldToStopItKillsThoseThatRun) {
  const auto begin = std::chrono::steady_clock::now();
  bool has_asked = false;
  EXPECT_FALSE(run_in_processes(
      2, {.num_processes = 2},
      [](std::size_t) {
        std::this_thread::sleep_for(milliseconds(60000));
        return 0;
      },
      [](const TaskEnd&) { FAIL() << "none ends by itself"; }, [&] { return !std::exchange(has_asked, true); }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(ProcessPool, AThousandTasksLeaveNoFileOpen) {
  run(1, {}, [](std::size_t) { return 0; });
  const int before = num_open_files();
  EXPECT_EQ(run(1000, {.num_processes = 4}, [](std::size_t) { return 0; }).size(), 1000u);
  EXPECT_EQ(num_open_files(), before);
}

}  // namespace
}  // namespace patrol::app::process_pool_test
