#include "io/files/line_reader.h"

#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/gzip_file.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::line_reader_test {
namespace {

using test::gzipped, test::TemporaryFile, test::TemporaryFolder;
using ::testing::ElementsAre;

std::vector<std::string> all_lines(const std::string& path) {
  LineReader reader(path);
  std::vector<std::string> lines;
  while (const auto line = reader.next()) lines.push_back(std::to_string(line->number) + ":" + std::string(line->text));
  return lines;
}

TEST(LineReader, NumbersLinesFromOneWithOrWithoutALastNewline) {
  EXPECT_THAT(all_lines(TemporaryFile("a", "one\n\nthree\n").path()), ElementsAre("1:one", "2:", "3:three"));
  EXPECT_THAT(all_lines(TemporaryFile("a", "one\ntwo").path()), ElementsAre("1:one", "2:two"));
  EXPECT_THAT(all_lines(TemporaryFile("a", "").path()), ElementsAre());
}

TEST(LineReader, SkipsTheByteOrderMarkOfTheFirstLine) {
  EXPECT_THAT(all_lines(TemporaryFile("a", "\xEF\xBB\xBFone\n\xEF\xBB\xBFtwo").path()),
              ElementsAre("1:one", "2:\xEF\xBB\xBFtwo"));
}

TEST(LineReader, ReadsGzipAsThePlainFile) {
  EXPECT_THAT(all_lines(TemporaryFile("a.gz", gzipped("one\ntwo\n")).path()), ElementsAre("1:one", "2:two"));
}

TEST(LineReader, KeepsLinesThatCrossItsBuffer) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += std::string(static_cast<std::size_t>(i % 997), 'x') + std::to_string(i) + "\n";
  const TemporaryFile file("a", text);
  LineReader reader(file.path());
  std::string again;
  while (const auto line = reader.next()) again += std::string(line->text) + "\n";
  EXPECT_EQ(again, text);
}

TEST(LineReader, ALineOfOneMegabyteIsWholeAndOneByteMoreIsCut) {
  const std::string longest(LineReader::kMaxLineBytes, 'x');
  const TemporaryFile file("a", longest + "\n" + longest + "y\nlast\n");
  LineReader reader(file.path());
  const auto whole = reader.next();
  EXPECT_EQ(whole->text.size(), longest.size());
  EXPECT_FALSE(whole->is_cut);
  const auto cut = reader.next();
  EXPECT_TRUE(cut->is_cut);
  EXPECT_EQ(cut->text.size(), longest.size());
  const auto last = reader.next();
  EXPECT_EQ(last->text, "last");
  EXPECT_EQ(last->number, 3);
  EXPECT_FALSE(reader.next());
}

TEST(LineReader, AQuarterOfAGigabyteWithoutALineEndTakesTenMegabytesOfMemory) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "zeros", "");
  std::filesystem::resize_file(folder / "zeros", std::uintmax_t{1} << 28);  // sparse
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  LineReader reader(folder / "zeros");
  EXPECT_TRUE(reader.next()->is_cut);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.read_error(), "more than 67108864 bytes have no line's end, nothing is read")
      << "after 64 MB it is given up";
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 10'000) << "KiB";
}

TEST(LineReader, SaysThatGzipIsCutOffOrDamagedAfterTheLastGoodLine) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += std::to_string(i * 7919 % 10007) + "\n";
  std::string bytes = gzipped(text);
  {
    LineReader reader(TemporaryFile("a.gz", bytes).path());
    while (reader.next()) {}
    EXPECT_EQ(reader.read_error(), std::nullopt);
  }
  const TemporaryFile cut("a.gz", bytes.substr(0, bytes.size() / 2));
  LineReader reader(cut.path());
  int count = 0;
  while (reader.next()) ++count;
  EXPECT_EQ(reader.read_error(), "the gzip data are cut off");
  EXPECT_GT(count, 5'000);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 50; ++i) bytes[i] = '\x55';
  const TemporaryFile damaged("a.gz", bytes);
  LineReader other(damaged.path());
  while (other.next()) {}
  EXPECT_EQ(other.read_error(), "the gzip data are damaged");
}

TEST(LineReader, ProgressGrowsFromZeroToOne) {
  const TemporaryFile file("a", std::string(4'000'000, '\n'));
  LineReader reader(file.path());
  EXPECT_LT(reader.progress(), 0.1);
  double last = 0.0;
  while (const auto line = reader.next()) {
    if (line->number % 100'000 != 0) continue;
    EXPECT_GE(reader.progress(), last);
    last = reader.progress();
    if (line->number == 2'000'000) {
      EXPECT_NEAR(last, 0.5, 0.1);
    }
  }
  EXPECT_EQ(reader.progress(), 1.0);
}

TEST(LineReader, AMissingFileAndAFolderAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(LineReader(folder / "missing"), InputError);
  EXPECT_THROW(LineReader(folder.path()), InputError);
}

}  // namespace
}  // namespace patrol::io::line_reader_test
