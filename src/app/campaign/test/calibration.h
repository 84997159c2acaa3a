#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run/run_verdict.h"
#include "io/files/table.h"
#include "io/yaml/expectations.h"

namespace patrol::app {

/// Run of a scenario with one seed.
struct SeedRun {
  std::uint64_t seed = 1;
  RunVerdict verdict;
};

/// Metric of a scenario over several seeds, with its present and its proposed expectation.
struct CalibratedMetric {
  std::string metric;
  std::optional<io::Expectation> present;
  std::vector<double> values;               ///< values of the seeds that measured the metric, in the order of the seeds
  std::optional<io::Expectation> proposed;  ///< none if the values give none
  std::string note;                         ///< "measured with 8 of 10 seeds"

  /// Whether a value is outside the present expectation.
  bool is_missed() const;
  /// Upper limit of the present expectation relative to the highest value; none without an upper limit or with a
  /// highest value of zero.
  std::optional<double> slack() const;
};

/// Proposals for the expectations of a scenario.
struct Calibration {
  std::string name;  ///< name of the scenario
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> failures;      ///< "seed 3: fall: ..."; such runs give no values
  std::vector<CalibratedMetric> metrics;  ///< those expected, and the standard ones (limit_rules.h)
};

/// Status of a run that gives values: it ended, and the mission was completed unless the scenario expects otherwise.
bool is_sample(const io::Expectations& present, const RunVerdict& verdict);

/// Proposes limits for every metric that the scenario expects, and for the standard ones that all runs measured.
Calibration calibrate(const std::string& name, const io::Expectations& present, const std::vector<SeedRun>& runs);

/// Expectations to write: proposals, and present ones where there is no proposal. Unless `may_widen`, no limit is wider
/// than the present one.
io::Expectations expectations_of(const Calibration& calibration, bool may_widen);

/// Comment with the range of the values that a limit was derived from: "measured 0.0021 to 0.0032".
std::string measured_range(const CalibratedMetric& metric);

/// Section `expect:` of a scenario, with the measured range of each metric as a comment.
std::string expect_section(const Calibration& calibration, bool may_widen);

/// One row per metric: scenario, present limits, number of seeds, lowest and highest value, proposal, slack, note.
io::Table calibration_table(const std::vector<Calibration>& calibrations);
/// Formats the table of one scenario as text for a terminal.
std::string calibration_text(const Calibration& calibration);

}  // namespace patrol::app
