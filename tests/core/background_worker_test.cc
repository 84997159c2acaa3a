#include "core/background_worker.h"

#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace patrol::background_worker_test {
namespace {

TEST(BackgroundWorker, ExecutesTasksInOrderWithAndWithoutAThread) {
  for (const bool has_thread : {false, true}) {
    BackgroundWorker worker(has_thread);
    std::vector<int> order;
    BackgroundWorker::Ticket last = 0;
    for (int task = 0; task < 1000; ++task) last = worker.submit([&order, task] { order.push_back(task); });
    worker.wait(last);
    ASSERT_EQ(order.size(), 1000u) << has_thread;
    for (int task = 0; task < 1000; ++task) EXPECT_EQ(order[static_cast<std::size_t>(task)], task);
  }
}

TEST(BackgroundWorker, UsesAThreadOfItsOwnOnlyIfAsked) {
  for (const bool has_thread : {false, true}) {
    BackgroundWorker worker(has_thread);
    std::thread::id id;
    worker.run([&] { id = std::this_thread::get_id(); });
    EXPECT_EQ(id != std::this_thread::get_id(), has_thread);
  }
}

TEST(BackgroundWorker, PassesTheFirstExceptionOnAndSkipsTheTasksAfterIt) {
  BackgroundWorker worker(true);
  bool has_run = false;
  worker.submit([] { throw std::runtime_error("first"); });
  const auto last = worker.submit([&] { has_run = true; });
  try {
    worker.wait(last);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
  EXPECT_FALSE(has_run);
}

TEST(BackgroundWorker, CompletesItsTasksBeforeItEnds) {
  int count = 0;
  {
    BackgroundWorker worker(true);
    for (int task = 0; task < 100; ++task) worker.submit([&] { ++count; });
  }
  EXPECT_EQ(count, 100);
}

}  // namespace
}  // namespace patrol::background_worker_test
