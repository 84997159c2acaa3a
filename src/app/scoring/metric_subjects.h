#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/scenario/scenario.h"
#include "core/route.h"

namespace patrol::app {

/// Checks the station or the calibration parameter in the path of a known metric.
class MetricSubjects {
 public:
  /// `file`: of the scenario.
  MetricSubjects(const Scenario& scenario, std::filesystem::path file);

  /// Throws InputError, which begins with `location`, if the scenario does not have the station or the parameter of a
  /// metric.
  void check(const std::string& location, const std::string& metric);

 private:
  const Scenario& scenario_;
  std::filesystem::path file_;
  std::optional<Route> route_;  ///< loaded for the first metric that needs it
};

}  // namespace patrol::app
