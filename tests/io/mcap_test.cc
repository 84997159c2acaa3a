#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/output_error.h"
#include "io/mcap/mcap_reader.h"
#include "io/mcap/mcap_writer.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::mcap_test {
namespace {

using namespace std::chrono_literals;
using test::read_bytes, test::TemporaryFolder, test::write_bytes;

struct Entry {
  std::string topic;
  Time log_time;
  std::string cdr;
  friend bool operator==(const Entry&, const Entry&) = default;
};
void PrintTo(const Entry& entry, std::ostream* out) {
  *out << entry.topic << " at " << to_seconds(entry.log_time) << " s";
}

/// Ten seconds of /a at 10 Hz and /b at 1 Hz, with content that does not pack to nothing.
std::vector<Entry> make_entries() {
  std::vector<Entry> entries;
  std::uint32_t noise = 1;
  for (int i = 0; i < 100; ++i) {
    std::string cdr;
    for (int k = 0; k < 50; ++k) cdr += static_cast<char>((noise = noise * 1664525U + 1013904223U) >> 24);
    entries.push_back({"/a", i * 100ms, cdr});
    if (i % 10 == 0) entries.push_back({"/b", i * 100ms, fmt::format("b{}", i)});
  }
  return entries;
}

void write_log(const std::filesystem::path& file, const std::vector<Entry>& entries, bool close = true) {
  McapWriter writer(file);
  const auto a = writer.add_channel("/a", "test_msgs/msg/A", "uint8[] data\n");
  const auto b = writer.add_channel("/b", "test_msgs/msg/B", "string text\n");
  for (const Entry& entry : entries) writer.write(entry.topic == "/a" ? a : b, entry.log_time, entry.cdr);
  if (close) writer.close();
}

std::vector<Entry> read_log(const std::filesystem::path& file, const McapSelection& selection = {}) {
  std::vector<Entry> entries;
  read_mcap(
      file,
      [&](const McapMessage& message) {
        entries.push_back({message.channel.topic, message.log_time, std::string(message.cdr)});
      },
      selection);
  return entries;
}

/// Entries in the order of a permutation that moves them by up to several seconds.
std::vector<Entry> shuffled(std::vector<Entry> entries) {
  std::ranges::sort(entries, {}, [](const Entry& entry) { return entry.log_time.count() / 1'000'000 * 7919 % 10'007; });
  return entries;
}

std::string complaint_about(const std::filesystem::path& file) {
  try {
    read_log(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class Mcap : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::filesystem::path file = folder / "log.mcap";
  const std::vector<Entry> entries = make_entries();
};

TEST_F(Mcap, GivesBackEveryMessageInOrder) {
  write_log(file, entries);
  EXPECT_EQ(read_log(file), entries);
  McapReader reader(file);
  EXPECT_TRUE(reader.is_complete());
  EXPECT_EQ(reader.last_time(), Time(9900ms));
  const auto first = reader.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->channel.type, "test_msgs/msg/A");
  EXPECT_EQ(first->channel.definition, "uint8[] data\n");
}

TEST_F(Mcap, SameCallsGiveTheSameBytes) {
  write_log(file, entries);
  write_log(folder / "again.mcap", entries);
  EXPECT_EQ(read_bytes(file), read_bytes(folder / "again.mcap"));
}

TEST_F(Mcap, AFullDiskIsAnErrorOfTheOutputWhereverItIsNoticed) {
  write_log(file, entries);
  const std::uintmax_t size = std::filesystem::file_size(file);
  for (std::uintmax_t max_bytes = 0; max_bytes < size; max_bytes += 97) {
    const test::FileSizeLimit limit(max_bytes);
    EXPECT_THROW(write_log(folder / "full.mcap", entries), OutputError) << max_bytes << " of " << size << " bytes";
  }
  const test::FileSizeLimit limit(size - 1);
  EXPECT_THROW(write_log(folder / "full.mcap", entries), OutputError);
}

TEST_F(Mcap, EachTopicHasTheDefinitionOfItsOwnEvenWithATypeOfOneName) {
  McapWriter writer(file);
  const auto a = writer.add_channel("/a", "test_msgs/msg/A", "uint8[] data\n");
  const auto b = writer.add_channel("/b", "test_msgs/msg/A", "string text\n");
  const auto c = writer.add_channel("/c", "test_msgs/msg/A", "uint8[] data\n");
  for (const auto channel : {a, b, c}) writer.write(channel, 1s, "x");
  writer.close();
  std::vector<std::string> definitions;
  read_mcap(file, [&](const McapMessage& message) { definitions.push_back(message.channel.definition); });
  EXPECT_EQ(definitions, (std::vector<std::string>{"uint8[] data\n", "string text\n", "uint8[] data\n"}));
}

TEST_F(Mcap, TheTimeOfTheLastMessageIsThatOfTheWholeOrTruncatedFile) {
  write_log(file, entries);
  EXPECT_EQ(last_message_time(file), Time(9900ms));
  write_log(file, shuffled(entries), false);
  EXPECT_EQ(last_message_time(file), Time(9900ms));
  write_log(file, {}, false);
  EXPECT_THROW(last_message_time(file), InputError);
}

TEST_F(Mcap, AnEmptyLogIsComplete) {
  write_log(file, {});
  EXPECT_TRUE(read_log(file).empty());
  EXPECT_TRUE(McapReader(file).is_complete());
}

TEST_F(Mcap, AMessageOfThreeMegabytesSurvives) {
  std::string content(3'000'000, 'x');
  content.append("end");
  const std::vector<Entry> large = {{"/a", 1s, content}, {"/b", 2s, "after"}};
  write_log(file, large);
  EXPECT_EQ(read_log(file), large);
}

TEST_F(Mcap, SelectsByTopicAndByTimeBothEndsIncluded) {
  write_log(file, entries);
  EXPECT_EQ(read_log(file, {.topics = {"/b"}}).size(), 10U);
  EXPECT_TRUE(read_log(file, {.topics = {"/c"}}).empty());
  const std::vector<Entry> second = read_log(file, {.topics = {"/a"}, .from = 3s, .to = 4s});
  ASSERT_EQ(second.size(), 11U);
  EXPECT_EQ(second.front().log_time, Time(3s));
  EXPECT_EQ(second.back().log_time, Time(4s));
}

TEST_F(Mcap, EveryInstantIsFoundByItself) {
  write_log(file, entries);
  for (int i = 0; i < 100; ++i) {
    const Time instant = i * 100ms;
    ASSERT_EQ(read_log(file, {.topics = {}, .from = instant, .to = instant}).size(), i % 10 == 0 ? 2U : 1U) << i;
  }
}

TEST_F(Mcap, ByLogTimeAShuffledFileOf110MessagesIsInOrder) {
  const std::vector<Entry> unsorted = shuffled(entries);
  write_log(file, unsorted);
  EXPECT_EQ(read_log(file), unsorted);
  std::vector<Entry> sorted = unsorted;
  std::ranges::stable_sort(sorted, {}, &Entry::log_time);
  EXPECT_EQ(read_log(file, {.topics = {}, .order = McapOrder::kLogTime}), sorted);
  EXPECT_EQ(read_log(file, {.topics = {"/b"}, .order = McapOrder::kLogTime}).size(), 10U);
  EXPECT_EQ(McapReader(file).topics(), (std::set<std::string>{"/a", "/b"}));
}

TEST_F(Mcap, ByLogTimeAFileWithoutSummaryIsInTheOrderOfTheFile) {
  const std::vector<Entry> unsorted = shuffled(entries);
  write_log(file, unsorted, false);
  EXPECT_EQ(read_log(file, {.topics = {}, .order = McapOrder::kLogTime}), unsorted);
  EXPECT_FALSE(McapReader(file).topics());
}

TEST_F(Mcap, AWriterThatNeverClosedLeavesAllItsMessages) {
  write_log(file, entries, false);
  EXPECT_EQ(read_log(file), entries);
  EXPECT_FALSE(McapReader(file).is_complete());
  EXPECT_FALSE(McapReader(file).last_time());
}

/// Whether `some` are the first of `all`.
bool are_first_of(const std::vector<Entry>& some, const std::vector<Entry>& all) {
  return some.size() <= all.size() && std::equal(some.begin(), some.end(), all.begin());
}

TEST_F(Mcap, CutOffAnywhereItReadsUpToTheCut) {
  write_log(file, entries);
  const std::string whole = read_bytes(file);
  const std::filesystem::path cut = folder / "cut.mcap";
  std::size_t most = 0;
  for (std::size_t size = 8; size < whole.size(); size += 41) {
    write_bytes(cut, whole.substr(0, size));
    const std::vector<Entry> some = read_log(cut);
    ASSERT_TRUE(are_first_of(some, entries)) << "cut at byte " << size;
    ASSERT_GE(some.size(), most) << "cut at byte " << size;
    ASSERT_FALSE(McapReader(cut).is_complete()) << "cut at byte " << size;
    most = some.size();
  }
  EXPECT_EQ(most, entries.size());
}

TEST_F(Mcap, CutOffAfterFiveSecondsItStillHasTheFirstFour) {
  write_log(file, entries);
  const std::string whole = read_bytes(file);
  write_bytes(file, whole.substr(0, whole.size() / 2));
  const std::vector<Entry> some = read_log(file);
  ASSERT_FALSE(some.empty());
  EXPECT_GT(some.back().log_time, 3s);
  EXPECT_EQ(read_log(file, {.topics = {"/b"}, .from = 1s, .to = 2s}).size(), 2U);
}

/// The byte that the complaint names.
std::size_t byte_named_in(const std::string& complaint) {
  const std::size_t at = complaint.find(": byte ");
  return at == std::string::npos ? std::string::npos : std::strtoul(complaint.c_str() + at + 7, nullptr, 10);
}

// A flipped bit anywhere in the data is found (checksums), and the place named is the record that holds it;
// messages before are not held back.
TEST_F(Mcap, AFlippedBitNamesTheByteOfItsRecord) {
  write_log(file, entries);
  const std::string whole = read_bytes(file);
  const std::filesystem::path damaged = folder / "damaged.mcap";
  // Magic, then the header: a record's head of 9 and the texts "ros2" and "patrol" with their lengths.
  const std::size_t first_chunk = 8 + 9 + (4 + 4) + (4 + 6);
  std::size_t in_chunk = 0;
  for (std::size_t at = first_chunk + 9 + 40; at < first_chunk + 600;
       at += 7) {  // past the head, within the packed bytes
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    write_bytes(damaged, bytes);
    const std::string complaint = complaint_about(damaged);
    ASSERT_TRUE(complaint.starts_with(damaged.string() + ": byte ")) << "byte " << at << ": '" << complaint << "'";
    EXPECT_EQ(byte_named_in(complaint), first_chunk);
    ++in_chunk;
  }
  EXPECT_GT(in_chunk, 50U);
}

TEST_F(Mcap, NoFlippedBitCrashesTheReaderOrInventsMessages) {
  write_log(file, {entries.begin(), entries.begin() + 30});
  const std::string whole = read_bytes(file);
  const std::filesystem::path damaged = folder / "damaged.mcap";
  for (std::size_t at = 0; at < whole.size(); at += 13) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x80);
    write_bytes(damaged, bytes);
    try {
      EXPECT_LE(read_log(damaged).size(), 30U) << "byte " << at;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(damaged.string())) << error.what();
    }
  }
}

TEST_F(Mcap, OtherFilesAreRefused) {
  EXPECT_EQ(complaint_about(file), file.string() + ": cannot be read");
  write_bytes(file, "");
  EXPECT_EQ(complaint_about(file), file.string() + ": is not an MCAP file");
  write_bytes(file, "#ROSBAG V2.0\n and more");
  EXPECT_EQ(complaint_about(file), file.string() + ": is not an MCAP file");
  EXPECT_NE(complaint_about(folder.path()), "");
  EXPECT_THROW(McapWriter(folder / "missing" / "log.mcap"), InputError);
}

}  // namespace
}  // namespace patrol::io::mcap_test
