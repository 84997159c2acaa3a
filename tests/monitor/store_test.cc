#include "monitor/store.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/monitor/sample_results.h"
#include "tests/support/temporary_file.h"

namespace patrol::monitor::store_test {
namespace {

using namespace patrol::test;

std::int64_t count(Store& store, const std::string& table) {
  Statement row = store.database().prepare("SELECT count(*) FROM " + table);
  row.step();
  return row.integer(0);
}

TEST(Store, TheSameResultIsKeptOnce) {
  const TemporaryFolder folder;
  Store store(folder.path());
  const std::vector<Result> alarm = {event_result(1, "gas_alarm", "well_1", 640.0)};
  EXPECT_EQ(store.add(alarm, kNoon_ms), std::vector{StoreStatus::kNew});
  EXPECT_EQ(store.add(alarm, kNoon_ms + 5), std::vector{StoreStatus::kExisting});
  EXPECT_EQ(count(store, "results"), 1);
  EXPECT_EQ(count(store, "findings"), 1);
}

TEST(Store, AnotherOneOfTheSameIdChangesNothing) {
  const TemporaryFolder folder;
  Store store(folder.path());
  store.add({pose_result(1, 1.0)}, kNoon_ms);
  EXPECT_EQ(store.add({pose_result(1, 9.0), pose_result(2, 3.0)}, kNoon_ms),
            (std::vector{StoreStatus::kConflict, StoreStatus::kNew}));
  Statement row = store.database().prepare("SELECT data FROM results WHERE id = 'spot-1/run_1/1'");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.text(0), R"({"x":1.0,"y":2.0,"yaw":0.5})");
}

TEST(Store, NothingOfABatchIsKeptWhenOneFails) {
  const TemporaryFolder folder;
  Store store(folder.path());
  Result broken = pose_result(2);
  broken.data = "{}";  // as no reader lets it through
  EXPECT_ANY_THROW(store.add({pose_result(1), broken}, kNoon_ms));
  EXPECT_EQ(count(store, "results"), 0);
  EXPECT_EQ(count(store, "poses"), 0);
  EXPECT_EQ(store.add({pose_result(1)}, kNoon_ms), std::vector{StoreStatus::kNew});
}

TEST(Store, WhatItKeptIsThereWhenItIsOpenedAgain) {
  const TemporaryFolder folder;
  { Store(folder.path()).add({pose_result(1), event_result(2, "gas_alarm", "well_1")}, kNoon_ms); }
  Store again(folder.path());
  EXPECT_EQ(count(again, "results"), 2);
  EXPECT_EQ(again.add({pose_result(1)}, kNoon_ms), std::vector{StoreStatus::kExisting});
}

TEST(Store, ItsFilesAreReadableByTheirOwnerOnly) {
  const TemporaryFolder folder;
  const mode_t mask = ::umask(0);
  Store store(folder.path());
  store.add({pose_result(1)}, kNoon_ms);
  ::umask(mask);
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    struct stat info {};
    ASSERT_EQ(::stat(entry.path().c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0600U) << entry.path();
    ++num_files;
  }
  EXPECT_GE(num_files, 4);  // lock, database, write-ahead log and its index
}

TEST(Store, ASecondOneOnTheSameFolderIsRefused) {
  const TemporaryFolder folder;
  const Store store(folder.path());
  EXPECT_THROW(Store(folder.path()), InputError);
}

TEST(Store, AFileThatIsNoDatabaseIsRefused) {
  const TemporaryFolder folder;
  write_bytes(folder / "results.sqlite", std::string(5000, 'x'));
  EXPECT_THROW(Store(folder.path()), InputError);
}

TEST(Store, AnAlarmIsAcknowledgedOnce) {
  const TemporaryFolder folder;
  Store store(folder.path());
  store.add({event_result(1, "gas_alarm", "well_1")}, kNoon_ms);
  EXPECT_EQ(store.acknowledge(1, "Li", "valve closed", kNoon_ms + 9), AcknowledgeStatus::kDone);
  EXPECT_EQ(store.acknowledge(1, "Wu", "", kNoon_ms + 10), AcknowledgeStatus::kAlready);
  EXPECT_EQ(store.acknowledge(2, "Wu", "", kNoon_ms + 10), AcknowledgeStatus::kUnknown);
  Statement row = store.database().prepare("SELECT who, note, acknowledged_ms FROM findings");
  row.step();
  EXPECT_EQ(row.text(0) + ": " + row.text(1), "Li: valve closed");
  EXPECT_EQ(row.integer(2), kNoon_ms + 9);
}

TEST(Store, ANameOfSqlIsAName) {
  const TemporaryFolder folder;
  Store store(folder.path());
  const std::string name = "x'); DROP TABLE results; --";
  store.add({result_of("pose", {{"x", 0.0}, {"y", 0.0}, {"yaw", 0.0}}, 1, "run_1", name)}, kNoon_ms);
  Statement row = store.database().prepare("SELECT robot FROM robots");
  row.step();
  EXPECT_EQ(row.text(0), name);
  EXPECT_EQ(count(store, "results"), 1);
}

}  // namespace
}  // namespace patrol::monitor::store_test
