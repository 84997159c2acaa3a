#include "io/json/adaboost_json.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::adaboost_json_test {
namespace {

using test::read_bytes, test::TemporaryFile;
using Json = nlohmann::json;

const std::vector<std::string> kFeatures = {"distance", "overlap"};

Json make_model() {
  return Json::parse(R"({"features": ["distance", "overlap"],
                         "stumps": [{"feature": "overlap", "threshold": 0.25, "sign_above": 1, "weight": 1.5},
                                    {"feature": "distance", "threshold": -2, "sign_above": -1, "weight": 0.5}]})");
}

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("model.json", text);
  try {
    load_boosted_stumps(file.path(), kFeatures);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("model.json"));
  }
  return "";
}

std::string complaint_after(const std::function<void(Json& model)>& change) {
  Json model = make_model();
  change(model);
  return complaint_about(model.dump());
}

TEST(LoadBoostedStumps, ReadsWhatTheModelSays) {
  const TemporaryFile file("model.json", make_model().dump());
  const BoostedStumps model = load_boosted_stumps(file.path(), kFeatures);
  EXPECT_EQ(model.features, kFeatures);
  ASSERT_EQ(model.stumps.size(), 2U);
  EXPECT_EQ(model.stumps[0], (DecisionStump{.feature = 1, .threshold = 0.25, .sign_above = 1, .weight = 1.5}));
  EXPECT_EQ(model.margin({-3.0, 0.0}), -0.5);
}

TEST(LoadBoostedStumps, WhatWasSavedIsReadBackToTheBitAndSavedAgainIsTheSameFile) {
  const BoostedStumps model{.features = kFeatures,
                            .stumps = {{.feature = 0, .threshold = 1.0 / 3.0, .sign_above = -1, .weight = 0.1 + 0.2},
                                       {.feature = 1, .threshold = -1e-300, .sign_above = 1, .weight = 5e-324}}};
  const TemporaryFile file("model.json", ""), again("again.json", "");
  save_boosted_stumps(file.path(), model);
  const BoostedStumps read = load_boosted_stumps(file.path(), kFeatures);
  EXPECT_EQ(read, model);
  save_boosted_stumps(again.path(), read);
  EXPECT_EQ(read_bytes(file.path()), read_bytes(again.path()));
}

TEST(LoadBoostedStumps, AModelOfOtherFeaturesIsRefused) {
  const std::string complaint = "model.json: features must be distance, overlap: the model was trained for others";
  EXPECT_EQ(complaint_after([](Json& model) { model["features"] = {"overlap", "distance"}; }), complaint);
  EXPECT_EQ(complaint_after([](Json& model) { model["features"] = {"distance"}; }), complaint);
  EXPECT_EQ(complaint_after([](Json& model) {
              model["features"] = {1, 2};
            }),
            "model.json: features must be a list of words");
}

TEST(LoadBoostedStumps, EachMissingFieldIsNamed) {
  for (const char* key : {"features", "stumps"}) {
    EXPECT_EQ(complaint_after([&](Json& model) { model.erase(key); }),
              std::string("model.json: ") + key + " is missing");
  }
  for (const char* key : {"feature", "threshold", "sign_above", "weight"}) {
    EXPECT_EQ(complaint_after([&](Json& model) { model["stumps"][1].erase(key); }),
              std::string("model.json: stumps[1]: ") + key + " is missing");
  }
}

TEST(LoadBoostedStumps, EachWrongValueIsNamed) {
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"] = Json::array(); }),
            "model.json: stumps must be a list of at least one stump");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"] = 3; }), "model.json: stumps must be a list");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"][0] = 3; }), "model.json: stumps[0]: must be an object");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"][0]["feature"] = "length"; }),
            "model.json: stumps[0]: feature = length: is not one of the features");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"][0]["threshold"] = nullptr; }),
            "model.json: stumps[0]: threshold must be a number");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"][0]["sign_above"] = 0; }),
            "model.json: stumps[0]: sign_above = 0: must be 1 or -1");
  EXPECT_EQ(complaint_after([](Json& model) { model["stumps"][0]["weight"] = 0; }),
            "model.json: stumps[0]: weight must be positive");
  EXPECT_EQ(complaint_after([](Json& model) { model["version"] = 1; }), "model.json: unknown key version");
  EXPECT_EQ(complaint_about("{\"features\": "), "model.json:1: is not JSON: ends too early");
}

TEST(LoadBoostedStumps, AMillionStumpsAreRefused) {
  std::string many = "{\"features\": [\"distance\", \"overlap\"], \"stumps\": [{}";
  for (int i = 1; i < 1000000; ++i) many += ",{}";
  EXPECT_EQ(complaint_about(many + "]}"), "model.json: stumps: more than 10000 entries");
}

}  // namespace
}  // namespace patrol::io::adaboost_json_test
