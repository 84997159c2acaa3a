#include "app/scenario/settings_difference.h"

#include <map>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::app {
namespace {

/// Name or path, and text, of each field in the order of the settings.
using FieldTexts = std::vector<std::pair<std::string, std::string>>;

template <typename Value>
concept Scalar = std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>;

template <typename Value>
concept List = !Scalar<Value> && requires(const Value& value) {
  value.begin();
};

template <typename Settings>
std::string entry_text(const Settings& entry);

template <typename Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value.empty() ? "–" : value;
  } else if constexpr (Scalar<Value>) {
    return fmt::format("{}", value);
  } else if constexpr (List<Value>) {
    std::vector<std::string> parts;
    for (const auto& element : value) parts.push_back(text_of(element));
    return "[" + join(parts, ", ") + "]";
  } else {
    return entry_text(value);
  }
}

/// Collects the fields of one section.
struct EntryVisitor {
  FieldTexts fields;
  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    fields.emplace_back(name, text_of(value));
  }
};

/// Text of a list entry without defaults: "{name: pedestrian_1, speed_mps: 1.2}".
template <typename Settings>
std::string entry_text(const Settings& entry) {
  const Settings defaults;
  EntryVisitor standard, visitor;
  Settings::fields(defaults, standard);
  Settings::fields(entry, visitor);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < visitor.fields.size(); ++i) {
    const auto& [name, text] = visitor.fields[i];
    if (text != standard.fields[i].second) parts.push_back(fmt::format("{}: {}", name, text));
  }
  return "{" + join(parts, ", ") + "}";
}

/// Collects the fields of a section and of the sections in it.
class SectionVisitor {
 public:
  /// `presets` holds names of presets by the paths of their fields ("sensors.lidar.preset"). A section whose own preset
  /// differs is replaced by the preset named there, but keeps its fields `preset` and `enabled`.
  explicit SectionVisitor(std::map<std::string, std::string> presets = {}) : presets_(std::move(presets)) {}

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    const std::string path = prefix_ + name;
    if constexpr (std::is_same_v<Value, io::Expectations>) {
      return;
    } else if constexpr (Scalar<Value>) {
      fields_.emplace_back(path, text_of(value));
    } else if constexpr (List<Value>) {
      visit_list(path, value);
    } else if constexpr (requires { Value::of_preset(std::string()); }) {
      const auto preset = presets_.find(path + ".preset");
      visit_section(path, preset == presets_.end() ? value : with_preset(value, preset->second));
    } else {
      visit_section(path, value);
    }
  }
  const FieldTexts& fields() const { return fields_; }

 private:
  template <typename Value>
  void visit_list(const std::string& path, const std::vector<Value>& list) {
    if constexpr (Scalar<Value>) {
      fields_.emplace_back(path, text_of(list));
    } else {
      for (std::size_t i = 0; i < list.size(); ++i)
        fields_.emplace_back(fmt::format("{}.{}", path, i), text_of(list[i]));
    }
  }

  template <typename Settings>
  void visit_section(const std::string& path, const Settings& settings) {
    const std::string outer = std::exchange(prefix_, path + ".");
    Settings::fields(settings, *this);
    prefix_ = outer;
  }

  template <typename Settings>
  static Settings with_preset(const Settings& settings, const std::string& preset) {
    if (settings.preset == preset) return settings;
    Settings other = Settings::of_preset(preset);
    other.preset = settings.preset;
    other.enabled = settings.enabled;
    return other;
  }

  std::map<std::string, std::string> presets_;
  std::string prefix_;
  FieldTexts fields_;
};

}  // namespace

std::vector<SettingDifference> settings_differences(const Scenario& standard, const Scenario& scenario) {
  SectionVisitor visitor;
  Scenario::fields(scenario, visitor);
  SectionVisitor standard_visitor({visitor.fields().begin(), visitor.fields().end()});
  Scenario::fields(standard, standard_visitor);
  const std::map<std::string, std::string> standards(standard_visitor.fields().begin(),
                                                     standard_visitor.fields().end());
  std::vector<SettingDifference> differences;
  for (const auto& [path, text] : visitor.fields()) {
    const auto found = standards.find(path);
    const std::string was = found == standards.end() ? "" : found->second;
    if (was != text) differences.push_back({path, was, text});
  }
  return differences;
}

}  // namespace patrol::app
