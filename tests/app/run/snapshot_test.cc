#include "app/run/snapshot.h"

#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/common/temporary_folder.h"
#include "app/record/run_directory.h"
#include "app/run/run_once.h"
#include "core/error.h"
#include "io/logs/log_compare.h"

namespace patrol::app::snapshot_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::filesystem::path kRoot = PATROL_SOURCE_DIR;

Scenario scenario_of(const std::string& file, std::vector<std::string> overrides) {
  return load_scenario(kRoot / "worlds" / file, overrides);
}

void run(const Scenario& scenario, const std::filesystem::path& root, const RunMode& mode = {}) {
  NullObserver observer;
  ASSERT_TRUE(run_once(scenario, "test", kRoot, root, observer, mode));
}

void expect_equal_logs(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto difference = io::first_difference(RunDirectory{a}.log(), RunDirectory{b}.log());
  EXPECT_FALSE(difference) << b << ": " << io::describe(*difference);
}

struct Continued {
  std::string name, file;
  std::vector<std::string> overrides;
  double snapshot_period_s;
  std::vector<double> at_s;
};

class Branches : public testing::TestWithParam<Continued> {};

TEST_P(Branches, UnchangedTheyContinueWithTheSameMessagesInTwoThreadsAndSnapshotsChangeNothing) {
  const Continued& row = GetParam();
  const TemporaryFolder folder("branches");
  const Scenario scenario = scenario_of(row.file, row.overrides);
  const auto parent = folder.path() / "parent", plain = folder.path() / "plain";
  run(scenario, parent, {.snapshot_period_s = row.snapshot_period_s});
  run(scenario, plain);
  expect_equal_logs(plain, parent);
  for (const double at_s : row.at_s) {
    const auto branch = folder.path() / fmt::format("at_{}", at_s);
    run(scenario, branch, {.branch = BranchOrigin{parent, from_seconds(at_s)}, .num_threads = 2});
    expect_equal_logs(plain, branch);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, Branches,
    testing::Values(Continued{"street", "street/scenarios/short.yaml", {"time_limit_s=6"}, 2.0, {2.0, 3.3, 5.9}},
                    Continued{"slam_delay",
                              "street/scenarios/short.yaml",
                              {"time_limit_s=6", "stack.slam_delay_s=0.15"},
                              2.0,
                              {2.0, 3.3, 5.9}},
                    Continued{"tunnel", "tunnel/scenarios/navigate.yaml", {"time_limit_s=8"}, 3.0, {4.0, 7.0}},
                    Continued{"substation", "substation/scenarios/short.yaml", {"time_limit_s=6"}, 3.0, {3.0, 5.1}}),
    [](const auto& row) { return row.param.name; });

TEST(Branch, AFaultAfterTheInstantGivesTheMessagesOfAWholeRunWithTheFault) {
  const TemporaryFolder folder("fault");
  const auto path = [&](const char* name) { return folder.path() / name; };
  const std::string fault = "faults=[{sensor: lidar, kind: freeze, start_s: 3.0, duration_s: 1.5}]";
  run(scenario_of("street/scenarios/short.yaml", {"time_limit_s=6"}), path("parent"), {.snapshot_period_s = 2.0});
  const Scenario with_fault = scenario_of("street/scenarios/short.yaml", {"time_limit_s=6", fault});
  run(with_fault, path("whole"));
  run(with_fault, path("branch"), {.branch = BranchOrigin{path("parent"), from_seconds(2.998)}});
  expect_equal_logs(path("whole"), path("branch"));
  EXPECT_TRUE(io::first_difference(RunDirectory{path("parent")}.log(), RunDirectory{path("branch")}.log()));
}

TEST(BranchSettings, WhatShapesTheStateIsRefusedByNameAndWhatIsReadLaterIsNot) {
  const Scenario parent = scenario_of("street/scenarios/short.yaml", {});
  const auto check = [&](std::vector<std::string> overrides, double at_s) {
    check_branch_settings(parent, scenario_of("street/scenarios/short.yaml", std::move(overrides)), from_seconds(at_s));
  };
  EXPECT_NO_THROW(check({}, 10.0));
  EXPECT_NO_THROW(check({"time_limit_s=15", "leaks=[]", "wind.speed_mps=3"}, 10.0));
  EXPECT_NO_THROW(check({"faults=[{sensor: imu, start_s: 10.1}]", "kidnaps=[{at_s: 10}]"}, 10.0));
  for (const char* setting :
       {"seed=2", "sensors.lidar.rate_hz=5", "stack.slam.method=rbpf", "as_built.enabled=false", "start.yaw_deg=1"}) {
    const std::string path = std::string(setting).substr(0, std::string(setting).find('='));
    EXPECT_THAT([&] { check({setting}, 10.0); }, ThrowsMessage<InputError>(HasSubstr("--set " + path + ": cannot")));
  }
  EXPECT_THAT([&] { check({"time_limit_s=5"}, 10.0); },
              ThrowsMessage<InputError>(HasSubstr("time_limit_s = 5 is before the branch: must be at least 10.000 s")));
  EXPECT_THAT([&] { check({"faults=[{sensor: imu, start_s: 10}]"}, 10.0); },
              ThrowsMessage<InputError>(HasSubstr("up to 10.000 s cannot change")));
  EXPECT_THAT([&] { check({"kidnaps=[{at_s: 9.9}]"}, 10.0); },
              ThrowsMessage<InputError>(HasSubstr("up to 10.000 s cannot change")));
  EXPECT_THAT([&] { check({"faults=[{sensor: scanner, kind: freeze, start_s: 20}]"}, 10.0); },
              ThrowsMessage<InputError>(HasSubstr("first freeze of the scanner")));
}

TEST(Snapshots, TheNewestUpToTheInstantIsTaken) {
  const TemporaryFolder folder("snapshots");
  const SnapshotFolder snapshots(folder.path() / "s", "content", "name");
  EXPECT_FALSE(load_snapshot(folder.path() / "s", from_seconds(100), "content"));
  for (const double at_s : {2.0, 10.0, 60.0, 63.2})
    snapshots.save({.time = from_seconds(at_s), .bytes = std::string(1000, 'a') + std::to_string(at_s)});
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "s" / "63.2.snap"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "s" / "10.snap"));
  EXPECT_FALSE(load_snapshot(folder.path() / "s", from_seconds(1.999), "content"));
  EXPECT_EQ(load_snapshot(folder.path() / "s", from_seconds(2.0), "content")->time, from_seconds(2.0));
  EXPECT_EQ(load_snapshot(folder.path() / "s", from_seconds(63.1), "content")->time, from_seconds(60.0));
  const auto newest = load_snapshot(folder.path() / "s", Time::max(), "content");
  EXPECT_EQ(newest->time, from_seconds(63.2));
  EXPECT_THAT(newest->bytes, testing::EndsWith("63.200000"));
}

TEST(Snapshots, OfAnotherRunOrDamagedAreRefusedWithTheirFile) {
  const TemporaryFolder folder("damaged");
  const SnapshotFolder snapshots(folder.path(), "content", "name");
  snapshots.save({.time = from_seconds(2.0), .bytes = std::string(1000, 'a')});
  EXPECT_THAT([&] { load_snapshot(folder.path(), Time::max(), "other"); },
              ThrowsMessage<InputError>(HasSubstr("2.snap: belongs to another build")));
  const auto file = folder.path() / "2.snap";
  const auto size = std::filesystem::file_size(file);
  for (const auto cut : {size - 1, size - 10, std::uintmax_t{30}, std::uintmax_t{5}, std::uintmax_t{0}}) {
    std::filesystem::resize_file(file, cut);
    EXPECT_THAT([&] { load_snapshot(folder.path(), Time::max(), "content"); },
                ThrowsMessage<InputError>(HasSubstr("2.snap: is ")))
        << cut;
  }
}

TEST(Snapshots, OneFlippedBitAnywhereIsRefused) {
  const TemporaryFolder folder("flipped");
  const SnapshotFolder snapshots(folder.path(), "content", "name");
  std::string state;
  for (std::uint32_t i = 0, noise = 1; i < 400; ++i)
    state += static_cast<char>((noise = noise * 1664525U + 1013904223U) >> 24U);
  snapshots.save({.time = from_seconds(2.0), .bytes = state});
  const auto file = folder.path() / "2.snap";
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string bytes = content.str();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    std::ofstream(file, std::ios::binary) << flipped;
    EXPECT_THAT([&] { load_snapshot(folder.path(), Time::max(), "content"); },
                ThrowsMessage<InputError>(HasSubstr("2.snap: is ")))
        << i;
  }
}

TEST(Snapshots, OfVersion1WithoutAChecksumAreRefused) {
  const TemporaryFolder folder("old");
  std::ofstream(folder.path() / "2.snap") << "PATROL SNAPSHOT 1\n{}\n";
  EXPECT_THAT([&] { load_snapshot(folder.path(), Time::max(), "content"); },
              ThrowsMessage<InputError>(HasSubstr("2.snap: is not a snapshot of this version")));
}

TEST(BranchText, IsARunAndSeconds) {
  EXPECT_EQ(parse_branch("out/a@b@63.2").run, "out/a@b");
  EXPECT_EQ(parse_branch("out/a@b@63.2").at, from_seconds(63.2));
  for (const char* text :
       {"", "out/run", "out/run@", "out/run@x", "out/run@5s", "out/run@-1", "out/run@0", "out/run@1e300"})
    EXPECT_THAT([&] { parse_branch(text); }, ThrowsMessage<InputError>(HasSubstr("must be RUN@SECONDS"))) << text;
}

TEST(Snapshot, OfAStackInAnotherProcessIsRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder("external");
  Scenario scenario = scenario_of("street/scenarios/short.yaml", {"time_limit_s=1"});
  scenario.stack.slam.method = "submap_rbpf";
  NullObserver observer;
  EXPECT_THAT([&] { run_once(scenario, "t", kRoot, folder.path() / "run", observer, {.snapshot_period_s = 1.0}); },
              ThrowsMessage<InputError>(HasSubstr("snapshots: this SLAM method has none")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "run"));
}

}  // namespace
}  // namespace patrol::app::snapshot_test
