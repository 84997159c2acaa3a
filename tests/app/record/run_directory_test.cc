#include "app/record/run_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/common/output_directory.h"
#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::run_directory_test {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(RunDirectory, IsMadeWithItsParentsAndMarkedIncomplete) {
  const TemporaryFolder folder;
  const RunDirectory directory = begin_run_directory(folder / "runs/today/first");
  EXPECT_TRUE(std::filesystem::is_directory(directory.root));
  EXPECT_TRUE(std::filesystem::exists(incomplete_marker(directory.root)));
  EXPECT_FALSE(directory.is_complete());
}

TEST(RunDirectory, IsCompleteWhenTheMarkIsGoneAndMetricsAreThere) {
  const TemporaryFolder folder;
  const RunDirectory directory = begin_run_directory(folder / "run");
  test::write_bytes(directory.metrics(), "{}\n");
  EXPECT_FALSE(directory.is_complete());
  complete_output(directory.root);
  EXPECT_TRUE(directory.is_complete());
  std::filesystem::remove(directory.metrics());
  EXPECT_FALSE(directory.is_complete());
}

TEST(RunDirectory, AnEarlierRunsFilesAreRemoved) {
  const TemporaryFolder folder;
  const RunDirectory first = begin_run_directory(folder / "run");
  for (const auto& file : {first.scenario(), first.log(), first.metrics(), first.junit(), first.estimate(),
                           first.truth(), first.odometry(), first.map(), first.truth_map()}) {
    test::write_bytes(file, "old");
  }
  test::write_bytes(first.root / "still_12.5.png", "old");
  complete_output(first.root);

  const RunDirectory second = begin_run_directory(folder / "run");
  EXPECT_FALSE(second.is_complete());
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(second.root)) num_files += entry.exists();
  EXPECT_EQ(num_files, 1);  // the mark
}

TEST(RunDirectory, AFolderThatHoldsSomethingElseIsRefusedAndLeftAsItWas) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "thesis.tex", "three years of work");
  test::write_bytes(folder / "metrics.json", "mine");
  EXPECT_THAT([&] { (void)begin_run_directory(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("thesis.tex")));
  EXPECT_EQ(test::read_bytes(folder / "thesis.tex"), "three years of work");
  EXPECT_EQ(test::read_bytes(folder / "metrics.json"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "INCOMPLETE"));
}

TEST(RunDirectory, AnEarlierRunsScansAreRemovedAndAUsersFilesAreNot) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "scenario.yaml", "old");
  std::filesystem::create_directory(folder / "scans");
  test::write_bytes(folder / "scans/scans.json", "old");
  test::write_bytes(folder / "scans/notes.txt", "mine");
  EXPECT_THAT([&] { (void)begin_run_directory(folder.path()); },
              ThrowsMessage<InputError>(HasSubstr("scans/notes.txt")));
  EXPECT_EQ(test::read_bytes(folder / "scans/notes.txt"), "mine");
  std::filesystem::remove(folder / "scans/notes.txt");
  const RunDirectory run = begin_run_directory(folder.path());
  EXPECT_FALSE(std::filesystem::exists(run.scans()));

  std::filesystem::create_directory(folder / "log.mcap");
  test::write_bytes(folder / "log.mcap/mine", "mine");
  EXPECT_THAT([&] { (void)begin_run_directory(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("log.mcap")));
  EXPECT_EQ(test::read_bytes(folder / "log.mcap/mine"), "mine");
}

TEST(RunDirectory, AFolderInsideIsNotPartOfARun) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "holiday");
  EXPECT_THAT([&] { (void)begin_run_directory(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("holiday")));
}

TEST(RunDirectory, AFileInItsPlaceIsRefused) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "run", "a file");
  EXPECT_THAT([&] { (void)begin_run_directory(folder / "run"); }, ThrowsMessage<InputError>(HasSubstr("run")));
}

TEST(RunDirectory, OpensOnlyWhereALogLies) {
  const TemporaryFolder folder;
  EXPECT_THAT([&] { open_run_directory(folder.path()); }, ThrowsMessage<InputError>(HasSubstr("log.mcap")));
  EXPECT_THROW(open_run_directory(folder / "absent"), InputError);
  test::write_bytes(folder / "log.mcap", "log");
  EXPECT_EQ(open_run_directory(folder.path()).root, folder.path());
}

TEST(LogOf, IsThatOfARunDirectoryOrThePathItself) {
  const TemporaryFolder folder;
  EXPECT_EQ(log_of(folder.path()), folder.path()) << "a folder without a log";
  test::write_bytes(folder / "log.mcap", "log");
  EXPECT_EQ(log_of(folder.path()), folder / "log.mcap");
  EXPECT_EQ(log_of(folder / "log.mcap"), folder / "log.mcap");
  EXPECT_EQ(log_of("none.clf"), "none.clf");
}

}  // namespace
}  // namespace patrol::app::run_directory_test
