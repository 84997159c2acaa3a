#include "app/mapping/log_site.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::log_site_test {
namespace {

/// CARMEN log of a robot that stands in the middle of a room.
std::string standing_log() {
  std::string ranges, text;
  for (int beam = 0; beam < 181; ++beam) ranges += " 3.0";
  for (int scan = 0; scan < 5; ++scan)
    text += fmt::format("FLASER 181{} 0 0 0 0 0 0 {}.0 host {}.0\n", ranges, scan, scan);
  return text;
}

TEST(LogSite, ALogWithAPathOf0mIsNoMissionAndIsRefusedWithTheOptions) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "a.log", standing_log());
  EXPECT_THAT([&] { import_log_site({.file = folder / "a.log", .name = "a"}); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("a.log: the recorded path is 0.00 m long")));
}

}  // namespace
}  // namespace patrol::app::log_site_test
