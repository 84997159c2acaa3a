#include "link/process_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::link {
namespace {

class ProcessOutputTest : public testing::Test {
 protected:
  ~ProcessOutputTest() override { std::filesystem::remove(file_); }

  void print(std::string_view text) const {
    ASSERT_EQ(::write(output_.writing_end(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string written() const {
    std::ifstream file(file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) / ("process_output_" + std::to_string(::getpid()));
  ProcessOutput output_;
};

TEST_F(ProcessOutputTest, TheFileBeginsWithTheOutputBeforeIt) {
  print("before\n");
  EXPECT_FALSE(std::filesystem::exists(file_));
  output_.write_to(file_);
  print("after\n");
  output_.finish();
  EXPECT_EQ(written(), "before\nafter\n");
}

TEST_F(ProcessOutputTest, WhatThePipeHoldsDoesNotHaveToWaitForTheFile) {
  ::fcntl(output_.writing_end(), F_SETFL, O_NONBLOCK);
  const int capacity = ::fcntl(output_.writing_end(), F_GETPIPE_SZ);
  ASSERT_GE(capacity, 1 << 16);  // 1 MiB where the system allows it
  print(std::string(static_cast<std::size_t>(capacity), 'x'));
  output_.write_to(file_);
  output_.finish();
  EXPECT_EQ(written().size(), static_cast<std::size_t>(capacity));
}

TEST_F(ProcessOutputTest, FinishesAlthoughAProcessKeepsThePipeOpen) {
  output_.write_to(file_);
  print("last words\n");
  output_.finish();
  EXPECT_EQ(written(), "last words\n");
}

TEST_F(ProcessOutputTest, EndsWithTheProcess) {
  output_.write_to(file_);
  print("done\n");
  output_.close_writing_end();
  output_.finish();
  EXPECT_EQ(written(), "done\n");
}

TEST_F(ProcessOutputTest, NamesAFileThatCannotBeWritten) {
  try {
    output_.write_to("/no/such/folder/stack.log");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/no/such/folder/stack.log: cannot be written: No such file or directory");
  }
}

}  // namespace
}  // namespace patrol::link
