#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/blocks.h"

namespace patrol::studies {

/// Metric that a study computes for every variant and seed.
struct StudyMetric {
  std::string name;
  std::string unit;                ///< empty: dimensionless
  bool is_compared = false;        ///< compared with the published value, and with the variant's reference
  bool is_processor_time = false;  ///< processor time: not reproducible
};

/// Method in a world.
struct StudyVariant {
  std::string world;
  std::string method;
  int particles = 0;                               ///< 0 for methods without particles
  std::size_t reference = 0;                       ///< variant for the paired comparison
  std::vector<std::optional<double>> published{};  ///< [metric], published values; may be shorter
};

/// Metrics of one seed, [variant][metric]; NaN where a variant has no such metric.
using StudySample = std::vector<std::vector<double>>;

/// Reproduction of a published experiment: runs, metrics and published values.
struct Study {
  std::string name;
  std::string title;
  std::string source;      ///< publication and table
  std::string conditions;  ///< conditions that the publication leaves open, with the values used here
  int default_seeds = 20;
  std::string compared_with = "the first";  ///< reference of each variant, for display
  std::vector<StudyMetric> metrics{};
  std::vector<StudyVariant> variants{};
  std::function<StudySample(std::uint64_t seed)> run{};
  std::function<std::vector<report::Section>(std::uint64_t seed)> illustrate{};  ///< figures of one seed
};

}  // namespace patrol::studies
