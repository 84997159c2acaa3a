#include "app/common/progress_bar.h"

#include <gtest/gtest.h>

namespace patrol::app::progress_bar_test {
namespace {

TEST(RemainingText, ExtrapolatesTheElapsedTime) {
  EXPECT_EQ(remaining_text(10.0, 0.5), "10 s left");
  EXPECT_EQ(remaining_text(10.0, 0.2), "40 s left");
  EXPECT_EQ(remaining_text(60.0, 0.25), "3 min left");
  EXPECT_EQ(remaining_text(600.0, 0.05), "3 h 10 min left");
}

TEST(RemainingText, RoundsUp) {
  EXPECT_EQ(remaining_text(2.0, 0.9), "1 s left");
  EXPECT_EQ(remaining_text(100.0, 0.5), "2 min left");
}

TEST(RemainingText, IsEmptyWhileNothingIsKnownAndAtTheEnd) {
  EXPECT_EQ(remaining_text(0.9, 0.5), "");
  EXPECT_EQ(remaining_text(10.0, 0.0), "");
  EXPECT_EQ(remaining_text(10.0, 1.0), "");
}

}  // namespace
}  // namespace patrol::app::progress_bar_test
