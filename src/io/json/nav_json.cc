#include "io/json/nav_json.h"

#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxGoals = 1000;

SavedGoal read_goal(const std::string& place, const Json& json) {
  const JsonObject reader(place, json, {"number", "position", "orientation", "type", "accuracy"});
  SavedGoal goal{.number = reader.integer("number"),
                 .T_map_body = reader.pose(),
                 .type = reader.choice("type", kGoalTypes),
                 .accuracy_m = reader.number("accuracy")};
  if (goal.accuracy_m <= 0.0) reader.fail("accuracy must be positive");
  return goal;
}

}  // namespace

std::vector<SavedGoal> load_nav(const std::filesystem::path& file) {
  const std::string name = file.string();
  const Json json = load_json(file, kMaxGoals);
  if (!json.is_array() || json.empty()) throw InputError(name + ": must be a list of at least one goal");
  std::vector<SavedGoal> goals;
  std::set<int> numbers;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string place = fmt::format("{}: [{}]", name, i);
    goals.push_back(read_goal(place, json[i]));
    if (!numbers.insert(goals.back().number).second) {
      throw InputError(fmt::format("{}: number {}: duplicate", place, goals.back().number));
    }
  }
  return goals;
}

void save_nav(const std::filesystem::path& file, const std::vector<SavedGoal>& goals) {
  Json json = Json::array();
  for (const SavedGoal& goal : goals) {
    const Eigen::Quaterniond q = quaternion_from_yaw(goal.T_map_body.yaw);
    json.push_back({{"number", goal.number},
                    {"position", {goal.T_map_body.x, goal.T_map_body.y, 0.0}},
                    {"orientation", {q.x(), q.y(), q.z(), q.w()}},
                    {"type", name_of(goal.type)},
                    {"accuracy", goal.accuracy_m}});
  }
  save_text(file, json.dump(1) + "\n");
}

}  // namespace patrol::io
