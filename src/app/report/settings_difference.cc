#include "app/report/settings_difference.h"

#include <map>
#include <type_traits>

#include <fmt/format.h>

namespace patrol::app {
namespace {

template <typename Value>
concept Scalar = std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>;

template <typename Value>
concept List = !Scalar<Value> && requires(const Value& value) {
  value.begin();
};

template <typename Value>
std::string text_of(const Value& value);

/// Addresses of a struct's fields by name.
struct FieldPointers {
  std::map<std::string, const void*> by_name;
  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    by_name[name] = &value;
  }
};

template <typename Settings>
FieldPointers fields_of(const Settings& settings) {
  FieldPointers fields;
  Settings::fields(settings, fields);
  return fields;
}

/// Visits the fields of two structs of one type in pairs.
template <typename Use>
struct PairVisitor {
  FieldPointers standard;
  Use use;
  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    use(std::string(name), *static_cast<const Value*>(standard.by_name.at(name)), value);
  }
};

template <typename Settings, typename Use>
void for_each_pair(const Settings& standard, const Settings& value, const Use& use) {
  PairVisitor<Use> visitor{fields_of(standard), use};
  Settings::fields(value, visitor);
}

/// Text of a list entry without defaults: "{name: pedestrian_1, speed_mps: 1.2}".
template <typename Settings>
std::string entry_text(const Settings& entry) {
  std::vector<std::string> parts;
  for_each_pair(Settings{}, entry, [&](const std::string& name, const auto& standard, const auto& value) {
    if (text_of(standard) != text_of(value)) parts.push_back(fmt::format("{}: {}", name, text_of(value)));
  });
  return fmt::format("{{{}}}", fmt::join(parts, ", "));
}

template <typename Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string>) {
    return value.empty() ? "–" : value;
  } else if constexpr (Scalar<Value>) {
    return fmt::format("{}", value);
  } else if constexpr (List<Value>) {
    std::vector<std::string> parts;
    for (const auto& element : value) parts.push_back(text_of(element));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  } else {
    return entry_text(value);
  }
}

class Comparison {
 public:
  template <typename Settings>
  void compare_section(const std::string& path, const Settings& standard, const Settings& settings) {
    for_each_pair(standard, settings, [&](const std::string& name, const auto& was, const auto& is) {
      compare(path.empty() ? name : path + "." + name, was, is);
    });
  }
  std::vector<SettingDifference> take() { return std::move(differences_); }

 private:
  template <typename Value>
  void compare(const std::string& path, const Value& standard, const Value& value) {
    if constexpr (std::is_same_v<Value, io::Expectations>) {
      return;
    } else if constexpr (List<Value>) {
      compare_list(path, standard, value);
    } else if constexpr (Scalar<Value>) {
      if (standard != value) differences_.push_back({path, text_of(standard), text_of(value)});
    } else if constexpr (requires { Value::of_preset(std::string()); }) {
      Value preset = standard.preset == value.preset ? standard : Value::of_preset(value.preset);
      preset.preset = standard.preset;
      preset.enabled = standard.enabled;
      compare_section(path, preset, value);
    } else {
      compare_section(path, standard, value);
    }
  }

  template <typename Value>
  void compare_list(const std::string& path, const std::vector<Value>& standard, const std::vector<Value>& list) {
    if constexpr (Scalar<Value>) {
      if (standard != list) differences_.push_back({path, text_of(standard), text_of(list)});
    } else {
      for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string was = i < standard.size() ? text_of(standard[i]) : "", is = text_of(list[i]);
        if (was != is) differences_.push_back({fmt::format("{}.{}", path, i), was, is});
      }
    }
  }

  std::vector<SettingDifference> differences_;
};

}  // namespace

std::vector<SettingDifference> settings_differences(const Scenario& standard, const Scenario& scenario) {
  Comparison comparison;
  comparison.compare_section("", standard, scenario);
  return comparison.take();
}

}  // namespace patrol::app
