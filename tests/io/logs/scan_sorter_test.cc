#include "io/logs/scan_sorter.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::io::scan_sorter_test {
namespace {

using Order = ScanSorter::Order;
using ::testing::ElementsAre;

RecordedScan scan_at(int second, double x = 0.0) {
  RecordedScan scan;
  scan.scan.stamp = std::chrono::seconds(second);
  scan.T_odom_body.x = x;
  return scan;
}

long second_of(const RecordedScan& scan) {
  return std::chrono::duration_cast<std::chrono::seconds>(scan.scan.stamp).count();
}

std::vector<long> taken(ScanSorter& sorter) {
  std::vector<long> seconds;
  while (const auto scan = sorter.take(true)) seconds.push_back(second_of(*scan));
  return seconds;
}

TEST(ScanSorter, PutsScansInOrderOfTime) {
  ScanSorter sorter;
  EXPECT_EQ(sorter.add(scan_at(2)), Order::kInOrder);
  EXPECT_EQ(sorter.add(scan_at(3)), Order::kInOrder);
  EXPECT_EQ(sorter.add(scan_at(1)), Order::kReordered);
  EXPECT_THAT(taken(sorter), ElementsAre(1, 2, 3));
}

TEST(ScanSorter, ThoseOfOneStampKeepTheirOrder) {
  ScanSorter sorter;
  EXPECT_EQ(sorter.add(scan_at(1, 10.0)), Order::kInOrder);
  EXPECT_EQ(sorter.add(scan_at(1, 20.0)), Order::kInOrder);
  EXPECT_EQ(sorter.take(true)->T_odom_body.x, 10.0);
  EXPECT_EQ(sorter.add(scan_at(1, 30.0)), Order::kInOrder);
  EXPECT_EQ(sorter.take(true)->T_odom_body.x, 20.0);
  EXPECT_EQ(sorter.take(true)->T_odom_body.x, 30.0);
}

TEST(ScanSorter, HoldsThirtyTwoScansBack) {
  ScanSorter sorter;
  for (int i = 0; i < 32; ++i) {
    sorter.add(scan_at(i));
    EXPECT_FALSE(sorter.take(false));
  }
  sorter.add(scan_at(32));
  EXPECT_EQ(sorter.take(false)->scan.stamp, std::chrono::seconds(0));
  EXPECT_FALSE(sorter.take(false));
}

TEST(ScanSorter, DropsAScanBeforeOneThatWasTaken) {
  ScanSorter sorter;
  sorter.add(scan_at(5));
  sorter.take(true);
  EXPECT_EQ(sorter.add(scan_at(4)), Order::kTooLate);
  EXPECT_TRUE(sorter.is_empty());
}

TEST(ScanSorter, AScanOfTheFarFutureComesLast) {
  ScanSorter sorter;
  sorter.add(scan_at(1'000'000));
  std::vector<long> seconds;
  for (int i = 0; i < 100; ++i) {
    EXPECT_NE(sorter.add(scan_at(i)), Order::kTooLate);
    if (const auto scan = sorter.take(false)) seconds.push_back(second_of(*scan));
  }
  EXPECT_EQ(seconds.back(), 68) << "101 were added, 32 are held: the future's and 69 ... 99 less one";
  EXPECT_EQ(taken(sorter).back(), 1'000'000);
}

}  // namespace
}  // namespace patrol::io::scan_sorter_test
