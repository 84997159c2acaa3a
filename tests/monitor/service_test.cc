#include "monitor/service.h"

#include <gtest/gtest.h>

#include "tests/monitor/sample_results.h"
#include "tests/support/temporary_file.h"

namespace patrol::monitor::service_test {
namespace {

using Json = nlohmann::json;
using namespace patrol::test;

constexpr const char* kToken = "0123456789abcdef";

class RunningService : public testing::Test {
 protected:
  /// As the server does it: the head first.
  HttpResponse ask(const std::string& method, const std::string& path, const std::string& body = "",
                   const std::string& authorization = std::string("Bearer ") + kToken) {
    HttpRequest request{.peer = "10.0.0.7",
                        .local = "10.0.0.5",
                        .host = host_,
                        .method = method,
                        .path = path,
                        .parameters = {},
                        .authorization = authorization,
                        .body = {}};
    if (auto error_reply = service_.refuse(request)) return *error_reply;
    request.body = body;
    return service_.answer(request);
  }

  TemporaryFolder folder_;
  Store store_{folder_.path()};
  std::string log_, host_ = "10.0.0.5:8080";
  Service service_{store_, kToken, [this](const std::string& line) { log_ += line + "\n"; },
                   HostNames({"tunnel-office"})};
};

TEST_F(RunningService, TakesResultsAndSaysOfEachWhatBecameOfIt) {
  const std::string one = to_json(pose_result(1)), two = to_json(pose_result(2));
  EXPECT_EQ(ask("POST", "/api/results", one).body, R"({"results":[{"id":"spot-1/run_1/1","status":"stored"}]})");
  const HttpResponse both = ask("POST", "/api/results", "[" + one + "," + two + "]");
  EXPECT_EQ(both.status, 200);
  EXPECT_EQ(Json::parse(both.body)["results"][0]["status"], "known");
  EXPECT_EQ(Json::parse(both.body)["results"][1]["status"], "stored");
}

TEST_F(RunningService, AnotherContentUnderTheSameIdIs409AndLogged) {
  ask("POST", "/api/results", to_json(pose_result(1, 1.0)));
  const HttpResponse answer = ask("POST", "/api/results", to_json(pose_result(1, 2.0)));
  EXPECT_EQ(answer.status, 409);
  EXPECT_EQ(Json::parse(answer.body)["results"][0]["status"], "conflict");
  EXPECT_EQ(log_, "10.0.0.7 409: duplicate id spot-1/run_1/1 with a different result\n");
}

TEST_F(RunningService, ChangesNeedTheToken) {
  for (const char* path : {"/api/results", "/api/alarms/1/acknowledge"}) {
    for (const char* shown :
         {"", "Bearer", "Bearer ", "Bearer 0123456789abcdeg", "Basic 0123456789abcdef", "0123456789abcdef"})
      EXPECT_EQ(ask("POST", path, "", shown).status, 401) << shown;
  }
  EXPECT_EQ(Json::parse(ask("GET", "/api/robots", "", "").body)["robots"].size(), 0U);
}

TEST_F(RunningService, AnotherHostNameIs421InOneLineForReadingAndWriting) {
  for (const char* allowed : {"localhost:8080", "tunnel-office", "10.0.0.5:8080"}) {
    host_ = allowed;
    EXPECT_EQ(ask("GET", "/api/robots", "", "").status, 200) << allowed;
  }
  for (const char* other : {"evil.example:8080", "", "10.0.0.6"}) {
    host_ = other;
    EXPECT_EQ(ask("GET", "/api/robots", "", "").status, 421) << other;
    EXPECT_EQ(ask("GET", "/").status, 421) << other;
    EXPECT_EQ(ask("POST", "/api/results", "[]").status, 421) << other;
  }
  host_ = "evil.example";
  EXPECT_EQ(
      ask("GET", "/").body,
      R"({"error":"Host 'evil.example': unknown: must be the server's address, localhost, or a name of --allow-host"})");
}

TEST_F(RunningService, TheSchemeOfTheTokenHasNoCase) {
  for (const char* scheme : {"bearer ", "BEARER ", "Bearer  "}) {
    EXPECT_EQ(ask("POST", "/api/results", "[]", std::string(scheme) + kToken).status, 200) << scheme;
  }
  EXPECT_EQ(ask("POST", "/api/results", "[]", std::string("bearerx ") + kToken).status, 401);
}

TEST_F(RunningService, UnknownPathsAre404AndOtherMethods405) {
  for (const char* path : {"/..", "/../token", "/%2e%2e/token", "/token", "/page.css/..", "/api", "/api/results/",
                           "/api/maps/", "/api/maps/-1", "/api/maps/x", "/api/alarms/x/acknowledge", "//", ""}) {
    EXPECT_EQ(ask("GET", path).status, 404) << path;
  }
  EXPECT_EQ(ask("GET", "/api/results").status, 405);
  EXPECT_EQ(ask("DELETE", "/api/robots").status, 405);
  EXPECT_EQ(ask("POST", "/").status, 405);
  EXPECT_EQ(ask("GET", "/api/maps/5").status, 404);
}

TEST_F(RunningService, AWrongBodyIs400AndNothingIsKept) {
  for (const char* body : {"", "{}", "[{}]", "null", "[[[", "{\"schema\": \"patrol-result/2\"}"}) {
    const HttpResponse answer = ask("POST", "/api/results", body);
    EXPECT_EQ(answer.status, 400) << body;
    EXPECT_EQ(Json::parse(answer.body)["error"].get<std::string>().find('\n'), std::string::npos);
  }
  EXPECT_EQ(Json::parse(ask("GET", "/api/history").body)["results"].size(), 0U);
}

TEST_F(RunningService, AnAlarmIsAcknowledgedByNameAndNote) {
  ask("POST", "/api/results", to_json(event_result(1, "gas_alarm", "well_1")));
  EXPECT_EQ(ask("POST", "/api/alarms/1/acknowledge", R"({"who": "", "note": ""})").status, 400);
  EXPECT_EQ(ask("POST", "/api/alarms/1/acknowledge", R"({"who": "Li"})").status, 400);
  EXPECT_EQ(ask("POST", "/api/alarms/1/acknowledge", R"({"who": "Li", "note": "seen"})").status, 200);
  EXPECT_EQ(ask("POST", "/api/alarms/1/acknowledge", R"({"who": "Wu", "note": ""})").status, 409);
  EXPECT_EQ(ask("POST", "/api/alarms/9/acknowledge", R"({"who": "Wu", "note": ""})").status, 404);
  EXPECT_EQ(Json::parse(ask("GET", "/api/alarms").body)["findings"][0]["who"], "Li");
}

TEST_F(RunningService, APageFetchesNothingFromElsewhere) {
  const HttpResponse page = ask("GET", "/");
  const auto policy = std::find_if(page.headers.begin(), page.headers.end(),
                                   [](const auto& header) { return header.first == "Content-Security-Policy"; });
  ASSERT_NE(policy, page.headers.end());
  EXPECT_EQ(policy->second.find("default-src 'none'"), 0U);
  EXPECT_EQ(page.body.find("http://"), std::string::npos);
  EXPECT_EQ(page.body.find("https://"), std::string::npos);
  for (const char* part : {"/page.css", "/page.js", "/site.js", "/format.js", "/map.js", "/plots.js", "/uplot.js",
                           "/uplot.css", "/schema"})
    EXPECT_GT(ask("GET", part).body.size(), 100U) << part;
}

TEST_F(RunningService, AMapComesBackAsThePngThatWasSent) {
  const char* kTwoByOne =
      "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR4nGP4xwAAAf8A/5ijSg0AAAAASUVORK5CYII=";
  ask("POST", "/api/results",
      to_json(result_of(
          "map",
          {{"width", 2}, {"height", 1}, {"resolution_m", 0.1}, {"origin_m", {0.0, 0.0}}, {"png_base64", kTwoByOne}},
          1)));
  const HttpResponse image = ask("GET", "/api/maps/1");
  EXPECT_EQ(image.type, "image/png");
  EXPECT_EQ(image.body.substr(1, 3), "PNG");
}

}  // namespace
}  // namespace patrol::monitor::service_test
