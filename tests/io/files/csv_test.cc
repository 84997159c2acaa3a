#include "io/files/csv.h"

#include <gtest/gtest.h>

namespace patrol::io::csv_test {
namespace {

TEST(Csv, QuotesWhatNeedsItAndDoublesQuotes) {
  const Table table{
      .name = "t", .columns = {"a", "b,c"}, .rows = {{std::string("says \"x\""), std::string("two\nlines")}}};
  EXPECT_EQ(to_csv(table), "a,\"b,c\"\r\n\"says \"\"x\"\"\",\"two\nlines\"\r\n");
}

TEST(Csv, NumbersReadBackAsTheSameAndNothingIsEmpty) {
  const Table table{.name = "t",
                    .columns = {"a", "b", "c"},
                    .rows = {{0.1, std::int64_t{7}, {}}, {1.0 / 3.0, std::int64_t{-1}, 2.0}}};
  EXPECT_EQ(to_csv(table), "a,b,c\r\n0.1,7,\r\n0.3333333333333333,-1,2\r\n");
}

}  // namespace
}  // namespace patrol::io::csv_test
