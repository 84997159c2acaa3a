// Turns of a stack in another thread against bare messages of the same sizes, and what the built-in stack pays for
// decoded messages.
//   tests/bench/link_bench
// TurnAgainstBareSocket: a scan of 2000 beams to the stack and a velocity command back. The reference writes and reads
// the same numbers of bytes on a socket pair. Wall time; `ratio` is to be at most 4. DecodeAgainstEncode: the messages
// of 0.1 s of a quadruped, decoded for the stack, against their encoding for the log; `ratio` is to be at most 1.

#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/sensors/registry.h"
#include "io/logs/topics.h"
#include "link/link_error.h"
#include "link/stack_client.h"
#include "link/stack_server.h"
#include "tests/bench/ratio.h"

namespace patrol::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kBeams = 2000;
constexpr int kTurns = 1000;

std::pair<int, int> socket_pair() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("socketpair");
  return {ends[0], ends[1]};
}

LaserScan sample_scan() {
  LaserScan scan;
  scan.angle_min_rad = -2.0;
  scan.angle_increment_rad = 4.0 / kBeams;
  scan.ranges_m.assign(kBeams, 3.5F);
  return scan;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void transfer(int descriptor, std::string& bytes, bool is_write) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = is_write ? ::write(descriptor, bytes.data() + done, bytes.size() - done)
                                   : ::read(descriptor, bytes.data() + done, bytes.size() - done);
    if (count <= 0) return;
    done += static_cast<std::size_t>(count);
  }
}

/// Wall time of messages of two sizes, back and forth.
double bare_exchange_s(std::size_t there, std::size_t back) {
  const auto [near, far] = socket_pair();
  std::thread other([&, end = far] {
    std::string received(there, ' '), answer(back, ' ');
    for (int i = 0; i < kTurns; ++i) {
      transfer(end, received, false);
      transfer(end, answer, true);
    }
  });
  std::string sent(there, ' '), received(back, ' ');
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTurns; ++i) {
    transfer(near, sent, true);
    transfer(near, received, false);
  }
  const double seconds = seconds_since(start);
  other.join();
  ::close(near);
  ::close(far);
  return seconds;
}

/// Wall time of turns of the protocol.
double turns_s(const std::string& scan) {
  const auto [near, far] = socket_pair();
  std::thread stack([end = far] {
    link::StackClient client{link::Socket(end)};
    client.begin("bench", {}, 50ms);
    for (int i = 0; i < kTurns; ++i) {
      const link::ReceivedTurn turn = client.next_turn();
      client.publish(turn.now, VelocityCommand{.stamp = turn.now, .vx_mps = 0.5});
      client.done({.now = turn.now});
    }
  });
  link::StackServer server(link::Socket(near), {.timeout = 60s});
  server.declare(io::kTopic<LaserScan>, io::kRosType<LaserScan>);
  server.greet({});
  const auto start = std::chrono::steady_clock::now();
  Time now{};
  for (int i = 0; i < kTurns; ++i) {
    server.send(io::kTopic<LaserScan>, now, scan, true);
    now = server.turn(now, false).next_turn;
  }
  const double seconds = seconds_since(start);
  stack.join();
  return seconds;
}

void TurnAgainstBareSocket(benchmark::State& state) {
  const std::string scan = io::encode(sample_scan());
  double reference_s = 0.0, subject_s = 0.0;
  for (auto iteration : state) {
    reference_s += bare_exchange_s(scan.size(), 120);
    const double seconds = turns_s(scan);
    subject_s += seconds;
    state.SetIterationTime(seconds);
  }
  state.counters["ratio"] = subject_s / reference_s;
  state.counters["us_per_turn"] = 1e6 * subject_s / (kTurns * static_cast<double>(state.iterations()));
}
BENCHMARK(TurnAgainstBareSocket)->UseManualTime()->Unit(benchmark::kMillisecond);

void DecodeAgainstEncode(benchmark::State& state) {
  std::vector<SensorMessage> messages = {sample_scan()};
  JointState joints;
  joints.position_rad = joints.velocity_radps = joints.effort_nm = std::vector<double>(12);
  for (int i = 0; i < 40; ++i) messages.insert(messages.end(), {Imu{}, joints});
  Ratio ratio;
  for (auto iteration : state) {
    std::vector<std::pair<const char*, std::string>> encoded;
    ratio.reference([&] {
      for (const SensorMessage& message : messages) {
        std::visit(
            [&]<typename Message>(const Message& one) { encoded.emplace_back(io::kTopic<Message>, io::encode(one)); },
            message);
      }
    });
    state.SetIterationTime(ratio.subject([&] {
      for (const auto& [topic, cdr] : encoded) benchmark::DoNotOptimize(io::decode_as<SensorMessage>(topic, cdr));
    }));
  }
  ratio.report(state);
}
BENCHMARK(DecodeAgainstEncode)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
