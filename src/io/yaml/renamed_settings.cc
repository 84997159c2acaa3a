#include "io/yaml/renamed_settings.h"

#include <algorithm>

#include "io/yaml/renamed_keys.h"

namespace patrol::io {
namespace {

/// Returns the present path of a key whose former path equals `path`, or an empty text.
std::string_view row_of(std::string_view path) {
  for (const auto& keys : {renamed_scenario_keys(), renamed_stack_keys()}) {
    const auto row = std::find_if(keys.begin(), keys.end(), [&](const RenamedKey& key) { return key.before == path; });
    if (row != keys.end()) return row->now;
  }
  return {};
}

/// Returns the present path of a key whose parents have their present names.
std::string rename_last(const std::string& path) {
  if (const std::string_view now = row_of(path); !now.empty()) return std::string(now);
  for (const auto& keys : {renamed_scenario_keys(), renamed_stack_keys()}) {
    for (const RenamedKey& key : keys) {
      if (!key.before.starts_with("*.") || !path.ends_with(key.before.substr(1))) continue;
      return path.substr(0, path.size() - key.before.size() + 1) + std::string(key.now.substr(1));
    }
  }
  return path;
}

}  // namespace

std::string renamed_setting(std::string_view path) {
  std::string renamed;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    // A row with the former names of the parents comes first: its key has the name of another key of today.
    if (const std::string_view now = row_of(path.substr(0, end)); !now.empty()) {
      renamed = now;
    } else {
      if (!renamed.empty()) renamed += '.';
      renamed = rename_last(renamed.append(path.substr(begin, end - begin)));
    }
    begin = std::min(end + 1, path.size());
  }
  return renamed;
}

}  // namespace patrol::io
