#include "io/metrics_json.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

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

}  // namespace

void save_metrics(const std::filesystem::path& file, const Metrics& metrics) { save_text(file, metrics.dump(2) + "\n"); }

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
