#include "app/campaign/batch/result_store.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::app {

std::optional<RunVerdict> ResultStore::load(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const io::Metrics json = io::load_metrics(file(key));
  try {
    return verdict_from_json(json);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: invalid run result: {}", file(key).string(), error.what()));
  }
}

void ResultStore::save(const std::string& key, const RunVerdict& verdict) const {
  std::filesystem::create_directories(folder_);
  io::save_metrics(file(key), to_json(verdict));
}

void ResultStore::remove_stack_failure(const std::string& key) const {
  const std::optional<RunVerdict> verdict = load(key);
  if (verdict && (verdict->end == RunStatus::kStackFailed || verdict->end == RunStatus::kStackSilent))
    std::filesystem::remove(file(key));
}

void ResultStore::copy(const std::string& key, const ResultStore& from) const {
  std::filesystem::create_directories(folder_);
  io::save_text(file(key), io::load_text(from.file(key)));
}

}  // namespace patrol::app
