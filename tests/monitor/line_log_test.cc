#include "monitor/line_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include <gtest/gtest.h>

namespace patrol::monitor::line_log_test {
namespace {

class LineLogTo : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::pipe(ends_.data()), 0);
    before_ = std::signal(SIGPIPE, SIG_IGN);
  }
  void TearDown() override {
    for (const int end : ends_) ::close(end);
    std::signal(SIGPIPE, before_);
  }
  std::string read() {
    std::array<char, 65536> bytes{};
    const ssize_t count = ::read(ends_[0], bytes.data(), bytes.size());
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }

  std::array<int, 2> ends_{};
  void (*before_)(int) = nullptr;
};

TEST_F(LineLogTo, APipeGetsOneLinePerCall) {
  LineLog log(ends_[1]);
  log.write("a\nb");
  log.write(std::string(2000, 'x'));
  EXPECT_EQ(read(), "a\\nb\n" + std::string(500, 'x') + "\n");
}

TEST_F(LineLogTo, APipeThatIsNotReadLosesLinesAndSaysHowMany) {
  LineLog log(ends_[1]);
  int num_written = 0;
  for (; log.num_lost() == 0 && num_written < 10'000; ++num_written) log.write(std::string(400, 'x'));
  EXPECT_LT(num_written, 10'000);
  log.write("lost too");
  read();
  log.write("again");
  EXPECT_NE(read().find("2 earlier lines could not be written\nagain\n"), std::string::npos);
  EXPECT_EQ(log.num_lost(), 0U);
}

TEST_F(LineLogTo, APipeWithoutAReaderLosesLines) {
  LineLog log(ends_[1]);
  ::close(ends_[0]);
  log.write("x");
  EXPECT_EQ(log.num_lost(), 1U);
}

TEST_F(LineLogTo, AFullDeviceOrAClosedDescriptorLosesLines) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  LineLog log(full);
  log.write("x");
  EXPECT_EQ(log.num_lost(), 1U);
  ::close(full);
  log.write_with_time("x");
  EXPECT_EQ(log.num_lost(), 2U);
}

}  // namespace
}  // namespace patrol::monitor::line_log_test
