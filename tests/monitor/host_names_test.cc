#include "monitor/host_names.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::monitor::host_names_test {
namespace {

TEST(HostNames, LoopbackTheBoundAddressAndNamesThatWereGivenAreAllowed) {
  const HostNames names({"Tunnel-Office", "10.9.9.9", "fe80::7"});
  for (const char* host : {"localhost", "LOCALHOST:8080", "127.0.0.1:80", "[::1]:8080", "[::1]", "10.0.0.5:8080",
                           "tunnel-office:8080", "tunnel-OFFICE", "10.9.9.9", "[fe80::7]:80"}) {
    EXPECT_TRUE(names.allow(host, "10.0.0.5")) << host;
  }
  EXPECT_TRUE(names.allow("[fd00::5]:80", "fd00::5"));
}

TEST(HostNames, AnythingElseIsNot) {
  const HostNames names({"tunnel-office"});
  for (const char* host : {"", "evil.example", "evil.example:8080", "localhost.evil.example",
                           "localhost:8080@evil.example", "localhost:x", "10.0.0.6", "tunnel-office.evil.example",
                           "[::1", "[::1]x", ":8080", "127.0.0.1:80:80", "localhost/", "localhost evil"}) {
    EXPECT_FALSE(names.allow(host, "10.0.0.5")) << host;
  }
  EXPECT_FALSE(names.allow("", ""));
}

TEST(HostNames, ANameHasNoPort) {
  for (const char* wrong : {"", "office:8080", "[::1]:8080", "http://office", "a b"})
    EXPECT_THROW(HostNames({wrong}), InputError) << wrong;
}

}  // namespace
}  // namespace patrol::monitor::host_names_test
