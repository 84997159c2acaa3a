#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/sweep/fault_matrix.h"
#include "app/sweep/sweep_rows.h"

namespace patrol::app {

/// What a run with a fault came to.
enum class FaultOutcome {
  kSurvived,     ///< the mission was completed, and everything expected of it met
  kDegraded,     ///< it was completed, and something expected was missed
  kStopped,      ///< it was not completed, and the robot neither fell nor hit anything
  kUnsafe,       ///< a fall or a collision
  kNoResult,     ///< crashed, hung, or came to no score
};

inline constexpr std::array kFaultOutcomes = std::to_array<NamedValue<FaultOutcome>>({
    {FaultOutcome::kSurvived, "survived", "Mission completed without fall or collision, every expectation met"},
    {FaultOutcome::kDegraded, "degraded", "Mission completed, an expectation missed"},
    {FaultOutcome::kStopped, "stopped", "Mission not completed, no fall, no collision"},
    {FaultOutcome::kUnsafe, "UNSAFE", "A fall or a collision"},
    {FaultOutcome::kNoResult, "NO RESULT", "The run crashed, hung or came to no score"},
});
static_assert(is_in_order(kFaultOutcomes));

FaultOutcome outcome_of(const RunVerdict& verdict);

std::string_view text_of(FaultOutcome outcome);

/// A run with a fault, or the one without.
struct FaultRow {
  std::string name;     ///< of its variant
  FaultVariant fault;
  std::uint64_t seed = 1;
  std::optional<bool> is_executed;  ///< nothing for the run without
  FaultOutcome outcome = FaultOutcome::kNoResult;
  std::optional<double> num_noticed;  ///< times that the robot said of a sensor that it is wrong
  std::string end, message;
  std::vector<std::optional<double>> figures, without;  ///< [metric] of this run, and of the run without a fault of the same seed

  bool is_not_executed() const { return is_executed.has_value() && !*is_executed; }
};

std::vector<FaultRow> fault_rows(const SweepManifest& manifest, const SweepRows& rows);

/// "executed" or "NOT EXECUTED"; empty for the run without.
std::string executed_text(const FaultRow& row);

/// How many survived, stopped and were unsafe, in a sentence.
std::string faults_summary(const std::vector<FaultRow>& rows);

/// What the words mean.
std::string fault_legend();

}  // namespace patrol::app
