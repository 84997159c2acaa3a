#include "monitor/url.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::monitor::url_test {
namespace {

TEST(Url, HasHostAndPort) {
  EXPECT_EQ(parse_url("http://tunnel-office:8080/").host, "tunnel-office");
  EXPECT_EQ(parse_url("http://tunnel-office:8080/").port, "8080");
  EXPECT_EQ(parse_url("http://10.0.0.1").port, "80");
  EXPECT_EQ(parse_url("http://[::1]:99").host, "::1");
}

TEST(Url, AnythingElseIsRefused) {
  for (const char* wrong : {"", "localhost:8080", "https://a", "http://", "http://:80", "http://a:0", "http://a:65536",
                            "http://a:b", "http://a/b", "http://me@a"}) {
    EXPECT_THROW(parse_url(wrong), InputError) << wrong;
  }
}

TEST(Target, ParametersAreDecodedAndThePathIsNot) {
  std::string path;
  std::map<std::string, std::string, std::less<>> parameters;
  split_target("/a/%2e%2e?robot=spot+1%2F%3Cb%3E&x=&y&robot=2&%", path, parameters);
  EXPECT_EQ(path, "/a/%2e%2e");
  EXPECT_EQ(parameters["robot"], "spot 1/<b>");
  EXPECT_EQ(parameters["x"], "");
  EXPECT_FALSE(parameters.contains("y"));
}

}  // namespace
}  // namespace patrol::monitor::url_test
