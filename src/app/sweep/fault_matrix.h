#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scenario.h"
#include "app/sweep/sweep_rows.h"
#include "io/table.h"

namespace patrol::app {

/// Every kind of fault of every sensor that the scenario's robot has switched on, and of its remote control if it is driven by one; from
/// `start_s` on for `duration_s`. How large each is stands in fault_matrix.cc.
std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s, double duration_s);

/// "lidar: drift".
std::string variant_name(const sim::FaultSettings& fault);
/// "faults=[{...}]".
std::string fault_override(const sim::FaultSettings& fault);

/// What a run with a fault came to.
enum class FaultOutcome {
  kSurvived,     ///< the mission was completed, and everything expected of it met
  kDegraded,     ///< it was completed, and something expected was missed
  kStopped,      ///< it was not completed, and the robot neither fell nor hit anything
  kUnsafe,       ///< a fall or a collision
  kNoResult,     ///< crashed, hung, or came to no score
};

FaultOutcome outcome_of(const RunVerdict& verdict);

std::string_view text_of(FaultOutcome outcome);

/// A run with a fault, or the one without.
struct FaultRow {
  std::string fault;
  std::uint64_t seed = 1;
  std::string executed;  ///< "executed" or "NOT EXECUTED"; empty for the run without
  FaultOutcome outcome = FaultOutcome::kNoResult;
  std::optional<double> num_noticed;  ///< times that the robot said of a sensor that it is wrong
  std::string end, message;
  std::vector<std::optional<double>> figures, without;  ///< [metric] of this run, and of the run without a fault of the same seed
};

std::vector<FaultRow> fault_rows(const SweepManifest& manifest, const SweepRows& rows);

/// For a file.
io::Table faults_table(const SweepManifest& manifest, const SweepRows& rows);

/// For a screen.
std::string faults_text(const SweepManifest& manifest, const SweepRows& rows);

/// For documents, in Markdown: sensors down, kinds of fault across; in each the worst outcome of the seeds, the first metric (the mean of the
/// seeds that gave it), and whether the robot noticed.
std::string faults_markdown(const SweepManifest& manifest, const SweepRows& rows);

/// How many survived, stopped and were unsafe, in a sentence.
std::string faults_summary(const SweepManifest& manifest, const SweepRows& rows);

/// What the words mean.
std::string fault_legend();

}  // namespace patrol::app
