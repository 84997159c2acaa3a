#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace patrol::io {

/// metrics.json: a tree of named figures that keeps its order. A figure that could not be computed is null.
using Metrics = nlohmann::ordered_json;

/// Whole or not at all; two spaces of indentation, not a number written as null.
void save_metrics(const std::filesystem::path& file, const Metrics& metrics);

/// Throws InputError when there is no such file or it is not JSON.
Metrics load_metrics(const std::filesystem::path& file);

/// The figure at a path such as "pose.ate_rmse_m", "stations.0.map_error_m" or "stations.regulator_box_2.map_error_m" (an
/// entry of a list goes by its place or its "name"). True counts as 1, false as 0. None if there is no figure there.
std::optional<double> metric_at(const Metrics& metrics, const std::string& path);

/// Every figure with its path, in the tree's order: entries of lists by name if they have one. Words and nulls are left out.
std::vector<std::pair<std::string, double>> figures_of(const Metrics& metrics);

}  // namespace patrol::io
