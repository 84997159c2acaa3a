#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/campaign/sweep/fault_matrix.h"
#include "app/campaign/sweep/sweep_rows.h"

namespace patrol::app {

/// Outcome of a run with a fault.
enum class FaultOutcome {
  kSurvived,  ///< mission completed, every expectation met, the survival bounds (fault_matrix.h) among them
  kDegraded,  ///< mission completed, an expectation missed
  kStopped,   ///< mission not completed, no fall or collision
  kUnsafe,    ///< fall or collision
  kNoResult,  ///< crashed, hung, or without a score
};

inline constexpr std::array kFaultOutcomes = std::to_array<NamedValue<FaultOutcome>>({
    {FaultOutcome::kSurvived, "survived", "Mission completed without fall or collision, every expectation met"},
    {FaultOutcome::kDegraded, "degraded", "Mission completed, an expectation missed"},
    {FaultOutcome::kStopped, "stopped", "Mission not completed, no fall, no collision"},
    {FaultOutcome::kUnsafe, "UNSAFE", "A fall or a collision"},
    {FaultOutcome::kNoResult, "NO RESULT", "The run crashed, timed out or was not scored"},
});
static_assert(is_in_order(kFaultOutcomes));

FaultOutcome outcome_of(const RunVerdict& verdict);

std::string_view text_of(FaultOutcome outcome);

/// Row of a fault matrix: a run with a fault, or the one without.
struct FaultRow {
  std::string name;  ///< name of the variant
  FaultVariant fault;
  std::uint64_t seed = 1;
  std::optional<bool> was_triggered;  ///< empty for the run without a fault
  /// whether any metric but `performance` and the number of reported faults differs from the run without fault of this
  /// seed; a fault without effect says nothing about robustness, because the scenario does not need the sensor
  bool has_effect = false;
  FaultOutcome outcome = FaultOutcome::kNoResult;
  std::optional<double> num_detected;  ///< number of events in which the robot reported a faulty sensor
  std::string end, message;
  std::vector<std::optional<double>> values,
      baseline_values;  ///< [metric], this run and the run without fault of this seed

  bool is_without_effect() const { return !fault.kind.empty() && was_triggered.value_or(false) && !has_effect; }
  bool is_not_triggered() const { return was_triggered.has_value() && !*was_triggered; }
};

std::vector<FaultRow> fault_rows(const SweepManifest& manifest, const SweepRows& rows);

/// "triggered" or "not triggered"; empty for the run without a fault.
std::string trigger_text(const FaultRow& row);

/// "effect" or "no effect"; empty for the run without a fault and for faults that were not triggered.
std::string effect_text(const FaultRow& row);

/// Sentence with the number of runs by outcome.
std::string faults_summary(const std::vector<FaultRow>& rows);

/// Explanation of the outcomes.
std::string fault_legend();

}  // namespace patrol::app
