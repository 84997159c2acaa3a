#include "io/files/sqlite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "core/error.h"
#include "io/files/output_error.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::sqlite_test {
namespace {

using ::testing::ElementsAre;

const Table kRuns{.name = "runs",
                  .columns = {"variant", "pose.ate_rmse_m", "seed"},
                  .rows = {{std::string("a=\"1\""), 0.25, std::int64_t{1}}, {std::string("b"), {}, std::int64_t{2}}}};

/// The first column of every row that `sql` gives.
std::vector<std::string> ask(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(file.string().c_str(), &database), SQLITE_OK);
  std::vector<std::string> answers;
  const auto take = [](void* list, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(values[0] == nullptr ? "NULL" : values[0]);
    return 0;
  };
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), take, &answers, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
  return answers;
}

TEST(Sqlite, AFullDiskIsAnErrorOfTheOutputAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  const test::FileSizeLimit limit(4096);
  EXPECT_THROW(save_sqlite(folder / "a.sqlite", {kRuns}), OutputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "."));
}

TEST(Sqlite, AnswersQuestionsAboutItsRows) {
  const test::TemporaryFolder folder;
  save_sqlite(folder / "a.sqlite", {kRuns});
  EXPECT_THAT(ask(folder / "a.sqlite", "SELECT variant FROM runs WHERE \"pose.ate_rmse_m\" < 0.3"),
              ElementsAre("a=\"1\""));
  EXPECT_THAT(ask(folder / "a.sqlite", "SELECT \"pose.ate_rmse_m\" FROM runs ORDER BY seed"),
              ElementsAre("0.25", "NULL"));
}

TEST(Sqlite, TheSameTablesGiveTheSameBytes) {
  const test::TemporaryFolder folder;
  save_sqlite(folder / "a.sqlite", {kRuns});
  save_sqlite(folder / "b.sqlite", {kRuns});
  EXPECT_EQ(test::read_bytes(folder / "a.sqlite"), test::read_bytes(folder / "b.sqlite"));
}

TEST(Sqlite, APlaceThatCannotBeWrittenIsSaid) {
  EXPECT_THROW(save_sqlite("/nowhere/at/all.sqlite", {kRuns}), InputError);
}

}  // namespace
}  // namespace patrol::io::sqlite_test
