#include "io/yaml/settings_yaml.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "core/text.h"
#include "io/yaml/renamed_settings.h"
#include "io/yaml/yaml_document.h"

namespace patrol::io {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Keys of an override's path. The metric of an expectation is one key: expect.pose.ate_max_m.
std::vector<std::string> override_path(const std::string& text) {
  constexpr std::string_view kExpect = "expect.";
  if (text.starts_with(kExpect)) return {"expect", text.substr(kExpect.size())};
  return split(text, '.');
}

/// Applies one "path=value" to the document and creates missing sections.
void apply_override(const YAML::Node& root, const std::string& override) {
  const std::size_t equals = override.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set " + override + ": must be path=value, e.g. sensors.lidar.range_noise_std_m=0.05");
  }
  const YAML::Node value = parse_yaml("--set " + override, override.substr(equals + 1), false);
  const std::string text = override.substr(0, equals);
  const std::vector<std::string> path = override_path(text);
  if (std::ranges::find(path, "") != path.end())
    throw InputError("--set " + override + ": " + text + " has an empty key: must be keys separated by one point each");
  if (const std::size_t bracket = text.find('['); path.front() != "expect" && bracket != std::string::npos) {
    throw InputError(
        fmt::format("--set {}: {}: must name entries of a list as in {}.0", override, text, text.substr(0, bracket)));
  }
  YAML::Node node = root;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_last = i + 1 == path.size();
    if (node.IsSequence()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(path[i].data(), path[i].data() + path[i].size(), index);
      if (error != std::errc() || end != path[i].data() + path[i].size()) {
        throw InputError("--set " + override + ": " + path[i] + " must be a list index");
      }
      if (index >= node.size())
        throw InputError(fmt::format("--set {}: the list has {} entries", override, node.size()));
      if (is_last) node[index] = value;
      else node.reset(node[index]);
    } else {
      if (node.IsDefined() && !node.IsNull() && !node.IsMap())
        throw InputError("--set " + override + ": " + path[i] + " is a child of a scalar");
      if (is_last) node[path[i]] = value;
      else {
        if (!node[path[i]].IsDefined()) node[path[i]] = YAML::Node(YAML::NodeType::Map);
        node.reset(node[path[i]]);
      }
    }
  }
}

}  // namespace

// yaml-cpp counts lines from 0.
int line_of(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

std::string closest_match(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t min_distance = std::max<std::size_t>(3, word.size() / 3 + 1);
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < min_distance) {
      min_distance = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string SettingsSource::location(int line, const std::string& key) const {
  for (auto override = overrides.rbegin(); override != overrides.rend(); ++override) {
    const std::string path = override->substr(0, override->find('='));
    if (key == path) return fmt::format("--set {}: ", *override);
    const bool is_above_new_key = line == 0 && !key.empty() && path.starts_with(key + ".");
    if (key.starts_with(path + ".") || is_above_new_key) return fmt::format("--set {}: {}: ", *override, key);
  }
  const std::string place = line > 0 ? fmt::format("{}:{}: ", file, line) : file + ": ";
  return key.empty() ? place : fmt::format("{}{}: ", place, key);
}

SettingsReader::SettingsReader(SettingsSource source, const YAML::Node& node, std::string path)
    : source_(std::move(source)), node_(node), path_(std::move(path)) {
  if (node_ && !node_.IsNull() && !node_.IsMap()) fail(node_, path_, "must be a section of keys and values");
}

void SettingsReader::operator()(const char* name, bool& value, const Limits&) {
  if (const YAML::Node node = child(name); node.IsDefined()) read_scalar(node, key(name), value);
}

void SettingsReader::operator()(const char* name, int& value, const Limits& limits) {
  if (const YAML::Node node = child(name); node.IsDefined()) read(node, key(name), value, limits);
}

void SettingsReader::operator()(const char* name, std::uint64_t& value, const Limits& limits) {
  if (const YAML::Node node = child(name); node.IsDefined()) read(node, key(name), value, limits);
}

void SettingsReader::operator()(const char* name, double& value, const Limits& limits) {
  if (const YAML::Node node = child(name); node.IsDefined()) read(node, key(name), value, limits);
}

void SettingsReader::operator()(const char* name, std::string& value, const Limits& limits) {
  if (const YAML::Node node = child(name); node.IsDefined()) read(node, key(name), value, limits);
}

void SettingsReader::operator()(const char* name, Expectations& value, const Limits&) {
  if (const YAML::Node node = child(name); node.IsDefined()) read_expectations(node, key(name), value);
}

YAML::Node SettingsReader::child(const char* name) {
  known_.emplace_back(name);
  const YAML::Node& document = node_;
  return document && document.IsMap() ? document[name] : YAML::Node(YAML::NodeType::Undefined);
}

void SettingsReader::fail(const YAML::Node& node, const std::string& key, const std::string& what) const {
  throw InputError(source_.location(line_of(node), key) + what);
}

void SettingsReader::finish() const {
  if (!node_ || !node_.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string name = entry.first.Scalar();
    if (!seen.insert(name).second) fail(entry.first, key(name), "duplicate key");
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    if (const std::string now = renamed_setting(key(name)); now != key(name))
      fail(entry.first, key(name), "renamed to " + now);
    const std::string nearest = closest_match(name, known_);
    fail(entry.first, key(name),
         fmt::format("unknown key{} (known: {})", nearest.empty() ? "" : "; did you mean " + nearest + "?",
                     join(known_, ", ")));
  }
}

void SettingsReader::read_scalar(const YAML::Node& node, const std::string& key, bool& value) const {
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) fail(node, key, "must be true or false");
}

void SettingsReader::read_scalar(const YAML::Node& node, const std::string& key, int& value) const {
  if (!node.IsScalar() || !YAML::convert<int>::decode(node, value)) {
    fail(node, key, "must be an integer" + (node.IsScalar() ? ", not " + node.Scalar() : ""));
  }
}

void SettingsReader::read_scalar(const YAML::Node& node, const std::string& key, std::uint64_t& value) const {
  if (!node.IsScalar() || node.Scalar().starts_with('-') || !YAML::convert<std::uint64_t>::decode(node, value)) {
    fail(node, key, "must be a non-negative integer" + (node.IsScalar() ? ", not " + node.Scalar() : ""));
  }
}

void SettingsReader::read_scalar(const YAML::Node& node, const std::string& key, double& value) const {
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    fail(node, key, "must be a number" + (node.IsScalar() ? ", not " + node.Scalar() : ""));
  }
  if (!std::isfinite(value)) fail(node, key, "must be a finite number, not " + node.Scalar());
}

void SettingsReader::read_scalar(const YAML::Node& node, const std::string& key, std::string& value) const {
  if (!node.IsScalar()) fail(node, key, "must be a string");
  value = node.Scalar();
}

void SettingsReader::check_limits(const YAML::Node& node, const std::string& key, bool is_allowed,
                                  const Limits& limits) const {
  if (!is_allowed) fail(node, key, fmt::format("{} is out of range: {}", node.Scalar(), describe_limits(limits)));
}

void SettingsReader::read(const YAML::Node& node, const std::string& key, int& value, const Limits& limits) const {
  read_scalar(node, key, value);
  check_limits(node, key, allows(limits, value), limits);
}

void SettingsReader::read(const YAML::Node& node, const std::string& key, std::uint64_t& value,
                          const Limits& limits) const {
  read_scalar(node, key, value);
  check_limits(node, key, allows(limits, static_cast<double>(value)), limits);
}

void SettingsReader::read(const YAML::Node& node, const std::string& key, double& value, const Limits& limits) const {
  read_scalar(node, key, value);
  check_limits(node, key, allows(limits, value), limits);
}

void SettingsReader::read(const YAML::Node& node, const std::string& key, std::string& value,
                          const Limits& limits) const {
  read_scalar(node, key, value);
  check_limits(node, key, allows(limits, value), limits);
}

void SettingsReader::read_expectations(const YAML::Node& node, const std::string& key, Expectations& value) const {
  if (!node.IsMap()) fail(node, key, "must be a section of metrics");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string metric = entry.first.Scalar(), path = fmt::format("{}.{}", key, metric);
    if (!seen.insert(metric).second) fail(entry.first, path, "duplicate key");
    Expectation expectation;
    if (bool wanted = false; entry.second.IsScalar() && YAML::convert<bool>::decode(entry.second, wanted)) {
      expectation = {.min = wanted ? 1.0 : 0.0, .max = wanted ? 1.0 : 0.0, .is_boolean = true};
    } else if (entry.second.IsMap()) {
      SettingsReader band(source_, entry.second, path);
      if (entry.second["min"].IsDefined()) band("min", expectation.min);
      if (entry.second["max"].IsDefined()) band("max", expectation.max);
      band.known_ = {"min", "max"};
      band.finish();
      if (entry.second.size() == 0) fail(entry.first, path, "must have min, max or both");
      if (expectation.min > expectation.max)
        fail(entry.first, path,
             fmt::format("min = {} exceeds max = {}: must be at most max", expectation.min, expectation.max));
    } else {
      read_scalar(entry.second, path, expectation.min);
      expectation.max = expectation.min;
    }
    value[metric] = expectation;
  }
}

void SettingsWriter::write(const bool& value) { out_ << value; }
void SettingsWriter::write(const int& value) { out_ << value; }
void SettingsWriter::write(const std::uint64_t& value) { out_ << value; }
void SettingsWriter::write(const double& value) { out_ << fmt::format("{}", value); }
void SettingsWriter::write(const std::string& value) { out_ << value; }
void SettingsWriter::write_key(const char* name) { out_ << YAML::Key << name << YAML::Value; }
void SettingsWriter::begin_list() { out_ << YAML::BeginSeq; }
void SettingsWriter::end_list() { out_ << YAML::EndSeq; }

void SettingsWriter::write(const Expectations& expectations) {
  out_ << YAML::BeginMap;
  for (const auto& [metric, expectation] : expectations) {
    out_ << YAML::Key << metric << YAML::Value;
    if (expectation.is_boolean) {
      out_ << (expectation.min > 0.5);
      continue;
    }
    out_ << YAML::Flow << YAML::BeginMap;
    if (std::isfinite(expectation.min)) out_ << YAML::Key << "min" << YAML::Value << fmt::format("{}", expectation.min);
    if (std::isfinite(expectation.max)) out_ << YAML::Key << "max" << YAML::Value << fmt::format("{}", expectation.max);
    out_ << YAML::EndMap;
  }
  out_ << YAML::EndMap;
}

YAML::Node load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  if (file.empty()) return parse_overrides(overrides);
  YAML::Node document = load_yaml(file);
  if (!document.IsDefined() || document.IsNull()) {
    throw InputError(file.string() + ": is empty: must be a map of keys and values ({} for none)");
  }
  if (!document.IsMap()) throw InputError(file.string() + ": must be a map of keys and values");
  for (const std::string& override : overrides) apply_override(document, override);
  return document;
}

YAML::Node parse_overrides(const std::vector<std::string>& overrides) {
  YAML::Node document(YAML::NodeType::Map);
  for (const std::string& override : overrides) apply_override(document, override);
  return document;
}

}  // namespace patrol::io
