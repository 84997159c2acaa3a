#include "app/campaign/batch/result_store.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::result_store_test {
namespace {

RunVerdict sample_row() {
  return {.end = RunStatus::kTimeLimit,
          .message = "after 9 s simulated",
          .metrics = {{"pose", {{"ate_rmse_m", 0.25}}}},
          .checks = {},
          .events = {}};
}

TEST(ResultStore, ARowComesBack) {
  const test::TemporaryFolder folder;
  const ResultStore store(folder / "runs");
  EXPECT_FALSE(store.load("ab").has_value());
  store.save("ab", sample_row());
  const RunVerdict row = store.load("ab").value();
  EXPECT_EQ(row.end, RunStatus::kTimeLimit);
  EXPECT_EQ(row.code(), ExitCode::kTimeLimit);
  EXPECT_EQ(io::metric_at(row.metrics, "pose.ate_rmse_m"), 0.25);
}

TEST(ResultStore, ACopyIsTheSameBytes) {
  const test::TemporaryFolder folder;
  const ResultStore a(folder / "a"), b(folder / "b");
  a.save("ab", sample_row());
  b.copy("ab", a);
  EXPECT_EQ(test::read_bytes(folder / "a/ab.json"), test::read_bytes(folder / "b/ab.json"));
}

TEST(ResultStore, ADamagedRowIsRefused) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "ab.json", "{\"end\": \"done\"}");
  EXPECT_THROW(ResultStore(folder.path()).load("ab"), InputError);
}

}  // namespace
}  // namespace patrol::app::result_store_test
