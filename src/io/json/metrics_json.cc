#include "io/json/metrics_json.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::io {
namespace {

const Metrics* entry_of(const Metrics& list, const std::string& word) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error == std::errc() && end == word.data() + word.size()) return index < list.size() ? &list[index] : nullptr;
  for (const Metrics& entry : list) {
    if (entry.is_object() && entry.contains("name") && entry["name"] == word) return &entry;
  }
  return nullptr;
}

const Metrics* child_of(const Metrics& parent, const std::string& word) {
  if (parent.is_array()) return entry_of(parent, word);
  if (!parent.is_object() || !parent.contains(word)) return nullptr;
  return &parent[word];
}

void add_metrics(const std::string& path, const Metrics& value, std::vector<std::pair<std::string, double>>& values) {
  const auto below = [&path](const std::string& word) { return path.empty() ? word : path + "." + word; };
  if (value.is_object()) {
    for (const auto& [key, child] : value.items()) add_metrics(below(key), child, values);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const bool is_named = value[i].is_object() && value[i].contains("name");
      add_metrics(below(is_named ? value[i]["name"].get<std::string>() : fmt::format("{}", i)), value[i], values);
    }
  } else if (value.is_boolean()) {
    values.emplace_back(path, value.get<bool>() ? 1.0 : 0.0);
  } else if (value.is_number() && std::isfinite(value.get<double>())) {
    values.emplace_back(path, value.get<double>());
  }
}

}  // namespace

std::vector<std::pair<std::string, double>> flatten_metrics(const Metrics& metrics) {
  std::vector<std::pair<std::string, double>> values;
  add_metrics("", metrics, values);
  return values;
}

void save_metrics(const std::filesystem::path& file, const Metrics& metrics) {
  save_text(file, metrics.dump(2) + "\n");
}

Metrics load_metrics(const std::filesystem::path& file) {
  try {
    return Metrics::parse(load_text(file));
  } catch (const Metrics::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON at byte {}", file.string(), error.byte));
  }
}

std::optional<double> metric_at(const Metrics& metrics, const std::string& path) {
  const Metrics* node = &metrics;
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');) {
    node = child_of(*node, word);
    if (node == nullptr) return std::nullopt;
  }
  if (node->is_boolean()) return node->get<bool>() ? 1.0 : 0.0;
  if (!node->is_number() || !std::isfinite(node->get<double>())) return std::nullopt;
  return node->get<double>();
}

}  // namespace patrol::io
