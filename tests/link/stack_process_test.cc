#include "link/stack_process.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::link {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

class StackProcessTest : public testing::Test {
 protected:
  StackProcessTest() { std::filesystem::create_directories(folder_); }
  ~StackProcessTest() override { std::filesystem::remove_all(folder_); }

  ProcessSettings settings(std::vector<std::string> words) const {
    return {.words = std::move(words), .environment = {}};
  }
  std::string output() const {
    std::ifstream file(output_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("stack_process_" + std::to_string(::getpid()));
  std::filesystem::path output_ = folder_ / "output.log";
};

TEST(CommandWords, SplitsAtBlanksOutsideOfQuotationMarks) {
  EXPECT_THAT(command_words("python3  my_stack.py --name 'a b'\t\"c d\" e\\ f ''"),
              ElementsAre("python3", "my_stack.py", "--name", "a b", "c d", "e f", ""));
  EXPECT_THAT(command_words("'a\\b' \"c\\\"d\""), ElementsAre("a\\b", "c\"d"));
  EXPECT_THAT(command_words("stack $HOME; rm *"), ElementsAre("stack", "$HOME;", "rm", "*"));  // no shell
}

TEST(CommandWords, RefusesNoCommandAndAnOpenQuotationMark) {
  EXPECT_THROW(command_words("  "), InputError);
  EXPECT_THROW(command_words("''"), InputError);
  EXPECT_THROW(command_words("stack 'a"), InputError);
}

TEST(CheckProgram, FindsProgramsByPathAndRefusesOthers) {
  EXPECT_NO_THROW(check_program("sh"));
  EXPECT_NO_THROW(check_program("/bin/sh"));
  EXPECT_THROW(check_program("no-such-program-of-patrol"), InputError);
  EXPECT_THROW(check_program("/etc/passwd"), InputError);
}

TEST_F(StackProcessTest, AFileThatIsNoProgramIsRefusedByThePermissionThatItLacks) {
  const auto refusal = [](const std::string& program) {
    try {
      check_program(program);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string file = (folder_ / "stack.py").string();
  EXPECT_EQ(refusal(file), "stack " + file + ": program not found");
  std::ofstream(file) << "print()\n";
  EXPECT_EQ(refusal(file),
            "stack " + file + ": not executable: must be made executable (chmod +x) or be started by its interpreter");
  EXPECT_EQ(refusal(folder_.string()), "stack " + folder_.string() + ": program not found");
  std::filesystem::permissions(file, std::filesystem::perms::owner_exec, std::filesystem::perm_options::add);
  EXPECT_EQ(refusal(file), "");
}

TEST_F(StackProcessTest, OutputGoesToTheFileAndTheVariablesToTheProcess) {
  ProcessSettings start = settings({"sh", "-c", "echo $GREETING; echo $0 >&2; exit 7", "it's"});
  start.environment = {{"GREETING", "hello there"}};
  StackProcess process(start);
  process.write_output_to(output_);
  EXPECT_TRUE(process.stop(30s));
  EXPECT_TRUE(process.has_failed());
  EXPECT_EQ(process.end_text(), "exited with code 7");
  EXPECT_EQ(output(), "hello there\nit's\n");
}

TEST_F(StackProcessTest, EndTextIsEmptyWhileItRunsAndNamesTheSignalAfterwards) {
  StackProcess process(settings({"sleep", "1000"}));
  EXPECT_TRUE(process.is_running());
  EXPECT_EQ(process.end_text(), "");
  EXPECT_FALSE(process.has_failed());
  EXPECT_FALSE(process.stop({}));
  EXPECT_TRUE(process.has_failed());
  EXPECT_EQ(process.end_text(), "was killed by signal 15 (Terminated)");
}

TEST_F(StackProcessTest, StopsAProcessThatIsStoppedAndIgnoresTheRequest) {
  const auto start = std::chrono::steady_clock::now();
  StackProcess process(settings({"sh", "-c", "trap '' TERM; echo ready; kill -STOP $$; while :; do sleep 0.05; done"}));
  process.write_output_to(output_);
  while (output() != "ready\n") ASSERT_LT(std::chrono::steady_clock::now() - start, 30s);
  process.stop({});
  EXPECT_EQ(process.end_text(), "was killed by signal 9 (Killed)");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

TEST_F(StackProcessTest, LimitsTheMemory) {
  ProcessSettings start = settings({"head", "-c", "1", "/dev/zero"});
  start.memory_bytes = 1 << 20;  // not enough to load the C library
  StackProcess process(start);
  process.stop(5s);
  EXPECT_THAT(process.end_text(), testing::AnyOf(HasSubstr("exited with code 127"), HasSubstr("signal")));
}

TEST_F(StackProcessTest, CpuTimeIsThatOfTheProcess) {
  StackProcess process(settings({"sh", "-c", "while :; do :; done"}));
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (cpu_seconds_of(process.id()).value() < 0.05) ASSERT_LT(std::chrono::steady_clock::now(), deadline);
  process.stop({});
  EXPECT_FALSE(cpu_seconds_of(process.id()).has_value());
}

}  // namespace
}  // namespace patrol::link
