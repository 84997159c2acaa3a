#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/settings.h"
#include "io/atomic_file.h"
#include "io/expectations.h"

/// Settings structs (core/settings.h) from YAML and back. A wrong file gives one sentence: file, line, key, rule.
namespace patrol::io {

/// Reads one document into a struct, field by field, and complains about whatever is left over.
class SettingsReader {
 public:
  SettingsReader(std::string file, YAML::Node node, std::string path) : file_(std::move(file)), node_(std::move(node)), path_(std::move(path)) {
    if (node_ && !node_.IsNull() && !node_.IsMap()) fail(node_, path_, "must be a section of keys and values");
  }

  template <typename Value>
  void operator()(const char* name, Value& value, const Limits& limits = {}) {
    known_.emplace_back(name);
    const YAML::Node child = node_ && node_.IsMap() ? node_[name] : YAML::Node(YAML::NodeType::Undefined);
    if (!child.IsDefined()) return;
    read(child, key(name), value, limits);
  }

  /// Unknown and repeated keys.
  void finish() const;

  template <typename Settings>
  static void read_section(const std::string& file, const YAML::Node& node, const std::string& path, Settings& settings) {
    SettingsReader reader(file, node, path);
    if constexpr (requires { Settings::of_preset(std::string()); }) {
      if (node.IsMap() && node["preset"].IsDefined()) {
        SettingsReader whole(file, node, path);
        Only preset{whole, "preset"};
        Settings::fields(settings, preset);
        const bool is_enabled = settings.enabled;
        settings = Settings::of_preset(settings.preset);
        settings.enabled = is_enabled;
      }
    }
    Settings::fields(settings, reader);
    reader.finish();
  }

 private:
  /// Reads nothing but one field.
  struct Only {
    SettingsReader& reader;
    std::string wanted;
    template <typename Value>
    void operator()(const char* name, Value& value, const Limits& limits = {}) {
      if (name == wanted) reader(name, value, limits);
    }
  };

  template <typename Value>
  void read(const YAML::Node& node, const std::string& key, Value& value, const Limits& limits) const {
    if constexpr (std::is_same_v<Value, Expectations>) {
      read_expectations(node, key, value);
    } else if constexpr (std::is_same_v<Value, std::string> || std::is_arithmetic_v<Value>) {
      read_scalar(node, key, value);
      if constexpr (!std::is_same_v<Value, bool>) {
        using Checked = std::conditional_t<std::is_same_v<Value, std::string>, std::string, double>;
        if (!allows(limits, static_cast<Checked>(value))) {
          fail(node, key, fmt::format("{} is out of range: {}", node.Scalar(), rule_of(limits)));
        }
      }
    } else if constexpr (requires { value.begin(); }) {
      if (!node.IsSequence()) fail(node, key, "must be a list");
      value.clear();
      for (std::size_t i = 0; i < node.size(); ++i) {
        value.emplace_back();
        read(node[i], fmt::format("{}.{}", key, i), value.back(), limits);
      }
    } else {
      read_section(file_, node, key, value);
    }
  }

  void read_scalar(const YAML::Node& node, const std::string& key, bool& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, int& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, std::uint64_t& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, double& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, std::string& value) const;
  void read_expectations(const YAML::Node& node, const std::string& key, Expectations& value) const;
  [[noreturn]] void fail(const YAML::Node& node, const std::string& key, const std::string& what) const;
  std::string key(const std::string& name) const { return path_.empty() ? name : path_ + "." + name; }

  std::string file_;
  YAML::Node node_;
  std::string path_;
  std::vector<std::string> known_;
};

/// Writes every field, defaults included.
class SettingsWriter {
 public:
  explicit SettingsWriter(YAML::Emitter& out) : out_(out) {}

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    out_ << YAML::Key << name << YAML::Value;
    write(value);
  }

  template <typename Settings>
  static void write_section(YAML::Emitter& out, const Settings& settings) {
    out << YAML::BeginMap;
    SettingsWriter writer(out);
    Settings::fields(settings, writer);
    out << YAML::EndMap;
  }

 private:
  template <typename Value>
  void write(const Value& value) {
    if constexpr (std::is_same_v<Value, Expectations>) {
      write_expectations(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      out_ << fmt::format("{}", value);
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
      out_ << value;
    } else if constexpr (requires { value.begin(); }) {
      out_ << YAML::BeginSeq;
      for (const auto& element : value) write(element);
      out_ << YAML::EndSeq;
    } else {
      write_section(out_, value);
    }
  }
  void write_expectations(const Expectations& expectations);

  YAML::Emitter& out_;
};

/// The file's document with the overrides ("a.b.0.c=value") put in. Throws InputError.
YAML::Node load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The overrides alone: without a file every value is a default or one of them.
YAML::Node document_of(const std::vector<std::string>& overrides);

/// Where it stands in its file, from 1; 0 for what an override made.
int line_of(const YAML::Node& node);

/// What the file says is put over what `settings` holds already.
template <typename Settings>
void read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides, Settings& settings) {
  SettingsReader::read_section(file.string(), load_document(file, overrides), "", settings);
}

template <typename Settings>
Settings load_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Settings settings;
  read_settings(file, overrides, settings);
  return settings;
}

/// Defaults, and what `--set` says over them. Throws InputError that names --set and the key.
template <typename Settings>
Settings settings_of(const std::vector<std::string>& overrides) {
  Settings settings;
  SettingsReader::read_section("--set", document_of(overrides), "", settings);
  return settings;
}

/// Every field, defaults included, below a line of comment if there is one.
template <typename Settings>
std::string to_yaml(const Settings& settings, const std::string& comment = "") {
  YAML::Emitter out;
  if (!comment.empty()) out << YAML::Comment(comment) << YAML::Newline;
  SettingsWriter::write_section(out, settings);
  return std::string(out.c_str()) + "\n";
}

template <typename Settings>
void save_settings(const std::filesystem::path& file, const Settings& settings, const std::string& comment = "") {
  save_text(file, to_yaml(settings, comment));
}

/// The known word nearest to `word` by edit distance; empty when none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace patrol::io
