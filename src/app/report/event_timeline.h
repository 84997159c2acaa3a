#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "report/blocks.h"

/// Events of a run for plots and tables.
namespace patrol::app {

/// One lane per kind of event, in the order of first occurrence; then collisions and kidnaps.
std::vector<report::EventTimeline::Lane> make_lanes(const RunContents& run);

/// Marks for error curves, from some of the lanes: failures, recoveries and relocalizations.
std::vector<report::PlotMark> marks_of(const RunContents& run);

/// Spans of faults, and of reported delocalization.
std::vector<report::PlotSpan> spans_of(const RunContents& run);

/// Table of all events, folded.
report::CollapsibleTables event_table(const RunContents& run);

}  // namespace patrol::app
