#pragma once

#include <string>

#include "app/campaign/sweep/fault_outcomes.h"
#include "io/files/table.h"

namespace patrol::app {

/// Fault matrix as a table for a file.
io::Table faults_table(const SweepManifest& manifest, const SweepRows& rows);

/// Fault matrix as text for a terminal.
std::string faults_text(const SweepManifest& manifest, const SweepRows& rows);

/// Fault matrix in Markdown: rows by sensor, columns by kind of fault. A cell has the worst outcome and
/// the largest value of the first metric over the seeds, whether no seed had an effect, and whether the robot reported
/// the fault in all of them.
std::string faults_markdown(const SweepManifest& manifest, const SweepRows& rows);

}  // namespace patrol::app
