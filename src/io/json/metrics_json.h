#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace patrol::io {

/// Content of metrics.json: an ordered tree of named metrics. A metric that could not be computed is null.
using Metrics = nlohmann::ordered_json;

/// Writes metrics.json atomically, indented by two spaces. NaN and infinity become null.
void save_metrics(const std::filesystem::path& file, const Metrics& metrics);

/// Reads metrics.json. Throws InputError if the file is missing or is not JSON.
Metrics load_metrics(const std::filesystem::path& file);

/// Returns the metric at a path such as "pose.ate_rmse_m", "stations.0.map_error_m" or
/// "stations.regulator_box_2.map_error_m". Entries of a list are addressed by index or by their "name". True counts as
/// 1, false as 0. Returns nullopt if there is no number at the path.
std::optional<double> metric_at(const Metrics& metrics, const std::string& path);

/// Returns all metrics with their paths, in tree order. Entries of lists are addressed by name if they have one.
/// Strings and nulls are skipped.
std::vector<std::pair<std::string, double>> flatten_metrics(const Metrics& metrics);

}  // namespace patrol::io
