#include "link/shared_core.h"

#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "link/stack_client.h"
#include "link/stack_server.h"

namespace patrol::link {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

using Cores = std::vector<std::size_t>;

/// Returns the cores of a thread; 0: of the calling one.
Cores cores_of(pid_t thread) {
  cpu_set_t set{};
  ::sched_getaffinity(thread, sizeof(set), &set);
  Cores cores;
  for (std::size_t core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  }
  return cores;
}

/// Sets the cores of the calling thread.
void use_cores(const Cores& cores) {
  cpu_set_t set{};
  for (const std::size_t core : cores) CPU_SET(core, &set);
  ::sched_setaffinity(0, sizeof(set), &set);
}

/// The main thread is that of the other process.
class SharedCoreTest : public testing::Test {
 protected:
  void SetUp() override {
    if (cores_.size() < 2) GTEST_SKIP() << "one core";
  }
  void TearDown() override { use_cores(cores_); }

  const Cores cores_ = cores_of(0);
};

TEST_F(SharedCoreTest, StackWaitsOnTheCoreOfTheSimulatorAndComputesOnAnyCore) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  std::atomic<pid_t> stack_thread = 0;
  std::vector<Cores> in_turns;
  std::thread stack([&, end = Socket(ends[1])]() mutable {
    StackClient client(std::move(end));
    client.wait_on_simulator_core();
    client.begin("test", {}, 10ms);
    EXPECT_EQ(::sched_getscheduler(0), SCHED_BATCH);
    stack_thread = ::gettid();
    for (bool is_last = false; !is_last;) {
      const ReceivedTurn turn = client.next_turn();
      in_turns.push_back(cores_of(0));
      is_last = turn.is_last;
      client.done({.now = turn.now});
    }
  });
  StackServer server(Socket(ends[0]), {.timeout = 5s});
  server.greet({});
  for (const std::size_t core : {cores_.back(), cores_.front()}) {
    use_cores({core});
    Cores waiting;
    // The stack may have begun to wait before the simulator moved.
    server.begin_turn(core == cores_.back() ? 10ms : 30ms, false);
    server.end_turn();
    const auto deadline = std::chrono::steady_clock::now() + 5s;
    while (waiting != Cores{core} && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(1ms);
      waiting = cores_of(stack_thread);
    }
    EXPECT_THAT(waiting, ElementsAre(core));
  }
  server.begin_turn(50ms, true);
  server.end_turn();
  stack.join();
  EXPECT_THAT(in_turns, ElementsAre(cores_, cores_, cores_));
}

TEST_F(SharedCoreTest, CoreThatTheThreadMustNotUseIsNotShared) {
  use_cores({cores_.front()});
  Cores bound;
  std::thread([&] {
    use_cores({cores_.back()});
    SharedCore core(::getpid());
    const SharedCore::Binding binding(&core);
    bound = cores_of(0);
  }).join();
  EXPECT_THAT(bound, ElementsAre(cores_.back()));
}

TEST_F(SharedCoreTest, UnknownProcessHasNoEffect) {
  SharedCore core(0);
  const SharedCore::Binding binding(&core);
  EXPECT_EQ(cores_of(0), cores_);
}

}  // namespace
}  // namespace patrol::link
