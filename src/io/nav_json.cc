#include "io/nav_json.h"

#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/json_object.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMostGoals = 1000;
constexpr const char* kGoalTypes = "NVDR";

MarkedGoal read_goal(const std::string& place, const Json& json) {
  const JsonObject reader(place, json, {"number", "position", "orientation", "type", "accuracy"});
  MarkedGoal goal{.number = reader.whole("number"), .T_map_body = reader.pose(), .type = 'N', .accuracy_m = reader.number("accuracy")};
  const std::string type = reader.word("type");
  if (type.size() != 1 || std::string(kGoalTypes).find(type[0]) == std::string::npos) {
    reader.fail(fmt::format("type = {}: must be N (stop there), V (pass by), D (scan the lining) or R (wait for the remote control)", type));
  }
  goal.type = type[0];
  if (goal.accuracy_m <= 0.0) reader.fail("accuracy must be positive");
  return goal;
}

}  // namespace

std::vector<MarkedGoal> load_nav(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = load_json(file, kMostGoals);
  if (!json.is_array() || json.empty()) throw InputError(name + ": must be a list of at least one goal");
  std::vector<MarkedGoal> goals;
  std::set<int> numbers;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string place = fmt::format("{}: [{}]", name, i);
    goals.push_back(read_goal(place, json[i]));
    if (!numbers.insert(goals.back().number).second) {
      throw InputError(fmt::format("{}: number {} stands there twice", place, goals.back().number));
    }
  }
  return goals;
}

void save_nav(const std::filesystem::path& file, const std::vector<MarkedGoal>& goals) {
  Json json = Json::array();
  for (const MarkedGoal& goal : goals) {
    const Eigen::Quaterniond q = quaternion_from_yaw(goal.T_map_body.yaw);
    json.push_back({{"number", goal.number},
                    {"position", {goal.T_map_body.x, goal.T_map_body.y, 0.0}},
                    {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                    {"type", std::string(1, goal.type)},
                    {"accuracy", goal.accuracy_m}});
  }
  save_text(file, json.dump(1) + "\n");
}

}  // namespace patrol::io
