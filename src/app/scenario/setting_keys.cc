#include "app/scenario/setting_keys.h"

#include <cstdlib>
#include <memory>
#include <string_view>
#include <type_traits>
#include <typeinfo>

#include <cxxabi.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/scenario/scenario.h"

namespace patrol::app {
namespace {

template <typename Type>
std::string type_name() {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(typeid(Type).name(), nullptr, nullptr, &status), &std::free);
  return status == 0 ? name.get() : typeid(Type).name();
}

/// Text of a value in YAML.
std::string yaml_text(const bool& value) { return value ? "true" : "false"; }
std::string yaml_text(const std::string& value) { return value.empty() ? "\"\"" : value; }
template <typename Number>
requires std::is_arithmetic_v<Number> std::string yaml_text(const Number& value) { return fmt::format("{}", value); }
template <typename Value>
std::string yaml_text(const std::vector<Value>& values) {
  std::vector<std::string> texts;
  for (const Value& value : values) texts.push_back(yaml_text(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

template <typename Value>
std::string kind_of() {
  if constexpr (std::is_same_v<Value, bool>) return "true or false";
  else if constexpr (std::is_integral_v<Value>) return "integer";
  else if constexpr (std::is_floating_point_v<Value>) return "number";
  else if constexpr (std::is_same_v<Value, std::string>) return "text";
  else return "list";
}

/// Admissible values without "must be"; empty if every finite value or text is.
std::string limits_text(const Limits& limits) {
  constexpr std::string_view kRule = "must be ";
  const std::string text = describe_limits(limits);
  const std::string values = text.starts_with(kRule) ? text.substr(kRule.size()) : text;
  return values == "finite" ? "" : values;
}

template <typename Value>
constexpr bool kIsLeaf = std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>;

/// Visitor that collects the fields of one settings struct and of the structs below it.
class KeyCollector {
 public:
  KeyCollector(std::string prefix, std::string owner, std::vector<SettingKey>& keys)
      : prefix_(std::move(prefix)), owner_(std::move(owner)), keys_(keys) {}

  void operator()(const char* name, const io::Expectations&, const Limits& = {}) {
    add(name, "expectations", "{}", "");
  }

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& limits = {}) {
    if constexpr (kIsLeaf<Value>) {
      add(name, kind_of<Value>(), yaml_text(value), limits_text(limits));
    } else if constexpr (requires { value.begin(); }) {
      using Element = typename Value::value_type;
      if constexpr (kIsLeaf<Element>) {
        add(name, "list", yaml_text(value), limits_text(limits));
      } else {
        add(name, "list", "", "");
        descend(prefix_ + name + "[].", Element());
      }
    } else {
      add(name, "section", "", "");
      descend(prefix_ + name + ".", value);
    }
  }

 private:
  void add(const std::string& name, const std::string& type, const std::string& default_value,
           const std::string& limits) {
    keys_.push_back(
        {.path = prefix_ + name, .owner = owner_, .type = type, .default_value = default_value, .limits = limits});
  }

  template <typename Settings>
  void descend(const std::string& prefix, const Settings& settings) {
    KeyCollector nested(prefix, type_name<Settings>(), keys_);
    Settings::fields(settings, nested);
  }

  std::string prefix_;
  std::string owner_;
  std::vector<SettingKey>& keys_;
};

}  // namespace

std::vector<SettingKey> setting_keys() {
  std::vector<SettingKey> keys;
  KeyCollector collector("", type_name<Scenario>(), keys);
  const Scenario defaults;
  Scenario::fields(defaults, collector);
  return keys;
}

}  // namespace patrol::app
