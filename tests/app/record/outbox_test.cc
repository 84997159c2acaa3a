#include "app/record/outbox.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/record/run_directory.h"
#include "core/error.h"
#include "io/files/output_error.h"
#include "tests/monitor/sample_results.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::outbox_test {
namespace {

using namespace patrol::test;

std::vector<int> sequences_of(const Outbox::Batch& batch) {
  std::vector<int> sequences;
  for (const std::string& result : batch.results) sequences.push_back(nlohmann::json::parse(result)["sequence"]);
  return sequences;
}

TEST(Outbox, GivesTheOldestUntilTheyAreMarkedAsSent) {
  const TemporaryFolder folder;
  Outbox outbox(folder.path());
  EXPECT_TRUE(outbox.next(10, 100'000).results.empty());
  for (int i = 0; i < 5; ++i) outbox.add(pose_result(i));
  const Outbox::Batch first = outbox.next(3, 100'000);
  EXPECT_EQ(sequences_of(first), (std::vector{0, 1, 2}));
  EXPECT_EQ(sequences_of(outbox.next(3, 100'000)), (std::vector{0, 1, 2}));
  outbox.mark_sent(first);
  EXPECT_EQ(outbox.num_pending(), 2U);
  EXPECT_EQ(sequences_of(outbox.next(3, 100'000)), (std::vector{3, 4}));
}

TEST(Outbox, GoesOnWhereAnotherProcessStopped) {
  const TemporaryFolder folder;
  {
    Outbox outbox(folder.path());
    for (int i = 0; i < 3; ++i) outbox.add(pose_result(i));
    outbox.mark_sent(outbox.next(1, 100'000));
  }
  Outbox again(folder.path());
  EXPECT_EQ(sequences_of(again.next(10, 100'000)), (std::vector{1, 2}));
}

TEST(Outbox, ALargeResultGoesAlone) {
  const TemporaryFolder folder;
  Outbox outbox(folder.path());
  for (int i = 0; i < 3; ++i) outbox.add(pose_result(i));
  EXPECT_EQ(outbox.next(10, 1).results.size(), 1U);
  const std::size_t one = outbox.next(1, 1).results[0].size() + 1;
  EXPECT_EQ(outbox.next(10, 2 * one).results.size(), 2U);
}

TEST(Outbox, ResultsLargerThanWhatIsReadAtOnceComeWhole) {
  const TemporaryFolder folder;
  Outbox outbox(folder.path());
  const std::string text(1'500'000, 'x');
  for (int i = 0; i < 3; ++i) outbox.add(event_result(i, "note", text));
  EXPECT_EQ(sequences_of(outbox.next(10, 100'000'000)), (std::vector{0, 1, 2}));
}

TEST(Outbox, AHalfWrittenLastLineIsLeftOut) {
  const TemporaryFolder folder;
  { Outbox(folder.path()).add(pose_result(0)); }
  write_bytes(folder / "outbox.jsonl", read_bytes(folder / "outbox.jsonl") + R"({"schema": "patr)");
  Outbox again(folder.path());
  const Outbox::Batch batch = again.next(10, 100'000);
  EXPECT_EQ(sequences_of(batch), std::vector{0});
  again.mark_sent(batch);
  EXPECT_TRUE(again.next(10, 100'000).results.empty());
  EXPECT_EQ(again.num_pending(), 0U);
}

TEST(Outbox, AResultThatCannotBeSetAsideIsAnErrorAndLeavesNoPart) {
  const TemporaryFolder folder;
  Outbox outbox(folder.path());
  outbox.set_aside("{}");
  {
    const FileSizeLimit full(10);
    EXPECT_THROW(outbox.set_aside(std::string(100, 'x')), io::OutputError);
  }
  EXPECT_EQ(read_bytes(folder / "outbox.refused.jsonl"), "{}\n");
  EXPECT_EQ(outbox.num_rejected(), 1U);
}

TEST(Outbox, ARunDirectoryWhoseResultsWaitIsNotUsedAgain) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scenario.yaml") << "{}\n";  // an earlier run's
  Outbox outbox(folder.path());
  outbox.add(pose_result(0));
  EXPECT_THROW(begin_run_directory(folder.path()), InputError);
  EXPECT_EQ(outbox.num_pending(), 1U);
  outbox.mark_sent(outbox.next(1, 100'000));
  begin_run_directory(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "outbox.jsonl"));
}

}  // namespace
}  // namespace patrol::app::outbox_test
