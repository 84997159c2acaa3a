#include "link/socket.h"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "link/link_error.h"

namespace patrol::link {
namespace {

using namespace std::chrono_literals;

TEST(ParseAddress, ReadsUnixAndTcp) {
  EXPECT_EQ(parse_address("unix:/tmp/a:b").path, "/tmp/a:b");
  const Address tcp = parse_address("tcp:127.0.0.1:5000");
  EXPECT_FALSE(tcp.is_unix);
  EXPECT_EQ(tcp.host, "127.0.0.1");
  EXPECT_EQ(tcp.port, 5000);
  EXPECT_TRUE(is_address("tcp:x") && is_address("unix:x"));
  EXPECT_FALSE(is_address("python3 stack.py"));
}

TEST(ParseAddress, RefusesWhatIsNoAddress) {
  for (const char* text : {"unix:", "tcp:", "tcp:5000", "tcp:localhost:", "tcp:localhost:70000", "tcp:localhost:5x",
                           "tcp:no such host:5000", "udp:localhost:5000"}) {
    EXPECT_THROW(parse_address(text), InputError) << text;
  }
}

TEST(Address, OnlyThisMachineIsLoopback) {
  EXPECT_TRUE(parse_address("unix:/tmp/a").is_loopback());
  EXPECT_TRUE(parse_address("tcp:localhost:1").is_loopback());
  EXPECT_TRUE(parse_address("tcp:127.0.0.2:1").is_loopback());
  EXPECT_FALSE(parse_address("tcp:0.0.0.0:1").is_loopback());
  EXPECT_FALSE(parse_address("tcp:192.168.1.2:1").is_loopback());
}

TEST(Socket, CarriesBytesOverTcp) {
  const Socket listener = Socket::listen(parse_address("tcp:127.0.0.1:0"));
  Socket client = Socket::connect({.is_unix = false, .host = "127.0.0.1", .port = listener.port()});
  Socket server = listener.accept({.timeout = 5s});
  client.send("hello", {.timeout = 5s});
  std::string received(5, '\0');
  std::size_t size = 0;
  while (size < 5) size += server.receive(received.data() + size, 5 - size, {.timeout = 5s});
  EXPECT_EQ(received, "hello");
}

TEST(Socket, UnixSocketIsForTheUserAloneAndReplacesNoFile) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("patrol_" + std::to_string(::getpid()));
  {
    const Socket listener = Socket::listen({.is_unix = true, .path = path});
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0077U, 0U);
    EXPECT_THROW(Socket::listen({.is_unix = true, .path = path}), InputError);
  }
  std::filesystem::remove(path);
}

TEST(Socket, ASocketOfAProcessThatHasEndedIsNamed) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("patrol_left_" + std::to_string(::getpid()));
  const std::string address = "unix:" + path.string();
  const auto refusal = [&] {
    try {
      Socket::listen(parse_address(address));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  {
    const Socket listener = Socket::listen(parse_address(address));
    EXPECT_EQ(refusal(), address + ": Address already in use");
    EXPECT_THROW(listener.accept({.timeout = 0ms}), LinkError);  // the refusal has not connected
  }
  EXPECT_EQ(refusal(), address + ": Address already in use, but no process listens there: remove the file");
  std::filesystem::remove(path);
  std::ofstream(path) << "no socket";
  EXPECT_EQ(refusal(), address + ": Address already in use");
  std::filesystem::remove(path);
}

TEST(Socket, WaitsForAClientNoLongerThanItsPatience) {
  const Socket listener = Socket::listen(parse_address("tcp:127.0.0.1:0"));
  try {
    listener.accept({.timeout = 200ms});
    FAIL() << "no error";
  } catch (const LinkError& error) {
    EXPECT_EQ(error.fault(), LinkFault::kTimeout);
    EXPECT_STREQ(error.what(), "no stack connected within 0.2 s");
  }
}

}  // namespace
}  // namespace patrol::link
