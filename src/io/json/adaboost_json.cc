#include "io/json/adaboost_json.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/atomic_file.h"
#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxStumps = 10000;

void check_features(const JsonObject& reader, const std::vector<std::string>& expected) {
  std::vector<std::string> names;
  for (const Json& name : reader.list("features")) {
    if (!name.is_string()) reader.fail("features must be a list of words");
    names.push_back(name.get<std::string>());
  }
  if (names != expected)
    reader.fail(fmt::format("features must be {}: the model was trained for others", join(expected, ", ")));
}

DecisionStump read_stump(const std::string& place, const Json& json, const std::vector<std::string>& features) {
  const JsonObject reader(place, json, {"feature", "threshold", "sign_above", "weight"});
  const std::string name = reader.string("feature");
  const auto feature = std::ranges::find(features, name);
  if (feature == features.end()) reader.fail(fmt::format("feature = {}: is not one of the features", name));
  const DecisionStump stump{.feature = static_cast<std::size_t>(feature - features.begin()),
                            .threshold = reader.number("threshold"),
                            .sign_above = reader.integer("sign_above"),
                            .weight = reader.number("weight")};
  if (stump.sign_above != 1 && stump.sign_above != -1)
    reader.fail(fmt::format("sign_above = {}: must be 1 or -1", stump.sign_above));
  if (stump.weight <= 0.0) reader.fail("weight must be positive");
  return stump;
}

}  // namespace

BoostedStumps load_boosted_stumps(const std::filesystem::path& file,
                                  const std::vector<std::string>& expected_features) {
  const std::string name = file.string();
  const Json json = load_json(file, kMaxStumps);
  const JsonObject reader(name, json, {"features", "stumps"});
  check_features(reader, expected_features);
  BoostedStumps model{.features = expected_features, .stumps = {}};
  const Json& stumps = reader.list("stumps");
  if (stumps.empty()) reader.fail("stumps must be a list of at least one stump");
  for (std::size_t i = 0; i < stumps.size(); ++i)
    model.stumps.push_back(read_stump(fmt::format("{}: stumps[{}]", name, i), stumps[i], model.features));
  return model;
}

void save_boosted_stumps(const std::filesystem::path& file, const BoostedStumps& model) {
  nlohmann::ordered_json stumps = nlohmann::ordered_json::array();
  for (const DecisionStump& stump : model.stumps) {
    stumps.push_back({{"feature", model.features[stump.feature]},
                      {"threshold", stump.threshold},
                      {"sign_above", stump.sign_above},
                      {"weight", stump.weight}});
  }
  const nlohmann::ordered_json json = {{"features", model.features}, {"stumps", stumps}};
  save_text(file, json.dump(1) + "\n");
}

}  // namespace patrol::io
