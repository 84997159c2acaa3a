#include "io/json/json_object.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"
#include "io/json/json_check.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::io {
namespace {

constexpr double kMinUprightCosine =
    0.707;  // cosine of the maximum tilt; also catches quaternions written as w, x, y, z

}  // namespace

Json load_json(const std::filesystem::path& file, std::size_t max_entries) {
  const std::string text = load_text(file);
  check_json(file.string(), text, max_entries);
  return Json::parse(text);
}

JsonObject::JsonObject(std::string place, const Json& json, const std::vector<std::string>& keys)
    : place_(std::move(place)), json_(json) {
  if (!json.is_object()) fail("must be an object");
  for (const auto& [key, value] : json.items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string nearest = closest_match(key, keys);
    fail(fmt::format("unknown key {}{}", key, nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
}

const Json& JsonObject::member(const char* key) const {
  if (!json_.contains(key)) fail(fmt::format("{} is missing", key));
  return json_.at(key);
}

const Json& JsonObject::list(const char* key) const {
  if (!member(key).is_array()) fail(fmt::format("{} must be a list", key));
  return member(key);
}

int JsonObject::integer(const char* key) const {
  const Json& value = member(key);
  if (!value.is_number_integer()) fail(fmt::format("{} must be an integer", key));
  const bool fits = value.is_number_unsigned() ? std::in_range<int>(value.get<std::uint64_t>())
                                               : std::in_range<int>(value.get<std::int64_t>());
  if (!fits) fail(fmt::format("{} is too large", key));
  return value.get<int>();
}

double JsonObject::number(const char* key) const {
  if (!member(key).is_number() || !std::isfinite(member(key).get<double>()))
    fail(fmt::format("{} must be a number", key));
  return member(key).get<double>();
}

std::string JsonObject::string(const char* key) const {
  const Json& value = member(key);
  if (!value.is_string() || has_control_characters(value.get_ref<const std::string&>()))
    fail(fmt::format("{} must be a string", key));
  return value.get<std::string>();
}

bool JsonObject::boolean(const char* key) const {
  if (!member(key).is_boolean()) fail(fmt::format("{} must be true or false", key));
  return member(key).get<bool>();
}

std::vector<double> JsonObject::numbers(const char* key, std::size_t count) const {
  return numbers_of(member(key), key, count);
}

std::vector<double> JsonObject::numbers_of(const Json& json, const std::string& what, std::size_t count) const {
  const auto refuse = [&] { fail(fmt::format("{} must be a list of {} numbers", what, count)); };
  if (!json.is_array() || json.size() != count) refuse();
  std::vector<double> values;
  for (const Json& value : json) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse();
    values.push_back(value.get<double>());
  }
  return values;
}

Pose2 JsonObject::pose() const {
  const std::vector<double> p = numbers("position", 3), q = numbers("orientation", 4);
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) fail("orientation must be a quaternion x, y, z, w of length 1");
  const double upright = (rotation * Eigen::Vector3d::UnitZ()).z();
  if (upright < kMinUprightCosine) fail("orientation must be upright within 45 degrees: a quaternion x, y, z, w");
  return {p[0], p[1], to_yaw(rotation)};
}

std::vector<Eigen::Vector2d> JsonObject::polyline(const char* key) const {
  std::vector<Eigen::Vector2d> line;
  const Json& points = member(key);
  if (!points.is_array()) fail(fmt::format("{} must be a list of points", key));
  for (const Json& point : points) {
    const std::vector<double> p = numbers_of(point, fmt::format("a point of {}", key), 2);
    line.emplace_back(p[0], p[1]);
  }
  if (line.size() < 2) fail(fmt::format("{} must have at least two points", key));
  return line;
}

void JsonObject::fail_choice(const char* key, const std::string& name, const std::vector<std::string>& allowed) const {
  fail(fmt::format("{} = {}: must be one of {}", key, name, join(allowed, ", ")));
}

void JsonObject::fail(const std::string& what) const { throw InputError(place_ + ": " + what); }

}  // namespace patrol::io
