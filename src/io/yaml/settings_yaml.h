#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/settings.h"
#include "io/files/atomic_file.h"
#include "io/yaml/expectations.h"

/// Conversion of settings structs (core/settings.h) from and to YAML. Errors name file, line, key and rule.
namespace patrol::io {

/// Origin of a document, for error messages.
struct SettingsSource {
  // NOLINTNEXTLINE(google-explicit-constructor): a file without overrides
  SettingsSource(std::string file_name, std::vector<std::string> given_overrides = {})
      : file(std::move(file_name)), overrides(std::move(given_overrides)) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  SettingsSource(const char* file_name) : file(file_name) {}

  /// Returns the start of an error message on a key: the override that sets it, or else the file with the line.
  std::string location(int line, const std::string& key) const;

  std::string file;
  std::vector<std::string> overrides;  ///< "path=value"
};

/// Reads a YAML document into a struct, field by field, and rejects remaining keys.
class SettingsReader {
 public:
  SettingsReader(SettingsSource source, const YAML::Node& node, std::string path);

  void operator()(const char* name, bool& value, const Limits& limits = {});
  void operator()(const char* name, int& value, const Limits& limits = {});
  void operator()(const char* name, std::uint64_t& value, const Limits& limits = {});
  void operator()(const char* name, double& value, const Limits& limits = {});
  void operator()(const char* name, std::string& value, const Limits& limits = {});
  void operator()(const char* name, Expectations& value, const Limits& limits = {});

  template <typename Value>
  void operator()(const char* name, Value& value, const Limits& limits = {}) {
    if (const YAML::Node node = child(name); node.IsDefined()) read(node, key(name), value, limits);
  }

  /// Throws InputError for unknown and duplicate keys.
  void finish() const;

  template <typename Settings>
  static void read_section(const SettingsSource& source, const YAML::Node& node, const std::string& path,
                           Settings& settings) {
    SettingsReader reader(source, node, path);
    if constexpr (requires { Settings::of_preset(std::string()); }) {
      if (node.IsMap() && node["preset"].IsDefined()) {
        SettingsReader whole(source, node, path);
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
  /// Visitor that reads only one field.
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
    if constexpr (requires { value.begin(); }) {
      if (!node.IsSequence()) fail(node, key, "must be a list");
      value.clear();
      for (std::size_t i = 0; i < node.size(); ++i) {
        value.emplace_back();
        read(node[i], key + "." + std::to_string(i), value.back(), limits);
      }
    } else {
      read_section(source_, node, key, value);
    }
  }
  void read(const YAML::Node& node, const std::string& key, int& value, const Limits& limits) const;
  void read(const YAML::Node& node, const std::string& key, std::uint64_t& value, const Limits& limits) const;
  void read(const YAML::Node& node, const std::string& key, double& value, const Limits& limits) const;
  void read(const YAML::Node& node, const std::string& key, std::string& value, const Limits& limits) const;

  void read_scalar(const YAML::Node& node, const std::string& key, bool& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, int& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, std::uint64_t& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, double& value) const;
  void read_scalar(const YAML::Node& node, const std::string& key, std::string& value) const;
  void read_expectations(const YAML::Node& node, const std::string& key, Expectations& value) const;
  void check_limits(const YAML::Node& node, const std::string& key, bool is_allowed, const Limits& limits) const;
  [[noreturn]] void fail(const YAML::Node& node, const std::string& key, const std::string& what) const;
  std::string key(const std::string& name) const { return path_.empty() ? name : path_ + "." + name; }
  /// Returns the node of a field and notes that the field is known; undefined if the document does not have it.
  YAML::Node child(const char* name);

  SettingsSource source_;
  YAML::Node node_;
  std::string path_;
  std::vector<std::string> known_;
};

/// Writes all fields, including those with default values.
class SettingsWriter {
 public:
  explicit SettingsWriter(YAML::Emitter& out) : out_(out) {}

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    write_key(name);
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
    if constexpr (requires { value.begin(); }) {
      begin_list();
      for (const auto& element : value) write(element);
      end_list();
    } else {
      write_section(out_, value);
    }
  }
  void write(const bool& value);
  void write(const int& value);
  void write(const std::uint64_t& value);
  void write(const double& value);
  void write(const std::string& value);
  void write(const Expectations& expectations);
  void write_key(const char* name);
  void begin_list();
  void end_list();

  YAML::Emitter& out_;
};

/// Loads a file, or no file for an empty path, and applies overrides ("a.b.0.c=value"). Throws InputError.
YAML::Node load_document(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// Returns a document that contains only the overrides; all other values are defaults.
YAML::Node parse_overrides(const std::vector<std::string>& overrides);

/// Returns the line of a node in its file, starting at 1; 0 for nodes from overrides.
int line_of(const YAML::Node& node);

/// Reads a file with overrides into `settings`; keys that are missing keep their present values.
template <typename Settings>
void read_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides, Settings& settings) {
  SettingsReader::read_section({file.empty() ? "--set" : file.string(), overrides}, load_document(file, overrides), "",
                               settings);
}

template <typename Settings>
Settings load_settings(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Settings settings;
  read_settings(file, overrides, settings);
  return settings;
}

/// Returns the defaults with the overrides of `--set`. Throws InputError with "--set" and the key.
template <typename Settings>
Settings parse_settings(const std::vector<std::string>& overrides) {
  Settings settings;
  SettingsReader::read_section({"--set", overrides}, parse_overrides(overrides), "", settings);
  return settings;
}

/// Formats all fields as YAML, including defaults, preceded by an optional comment line.
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

/// Returns the known word with the smallest edit distance to `word`; empty if none is similar.
std::string closest_match(const std::string& word, const std::vector<std::string>& known);

}  // namespace patrol::io
