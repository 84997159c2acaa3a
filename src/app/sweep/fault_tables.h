#pragma once

#include <string>

#include "app/sweep/fault_outcomes.h"
#include "io/table.h"

namespace patrol::app {

/// For a file.
io::Table faults_table(const SweepManifest& manifest, const SweepRows& rows);

/// For a screen.
std::string faults_text(const SweepManifest& manifest, const SweepRows& rows);

/// For documents, in Markdown: sensors down, kinds of fault across; in each the worst outcome of the seeds, the first metric (the mean of the
/// seeds that gave it), and whether the robot noticed.
std::string faults_markdown(const SweepManifest& manifest, const SweepRows& rows);

}  // namespace patrol::app
