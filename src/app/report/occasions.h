#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

/// Events of a run for plots and tables.
namespace patrol::app {

/// One lane per kind of event, in the order of first occurrence; then collisions and kidnaps.
std::vector<render::EventTimeline::Lane> lanes_of(const RunContents& run);

/// Marks for error curves, from some of the lanes: failures, recoveries and relocalizations.
std::vector<render::PlotMark> marks_of(const RunContents& run);

/// Spans of faults, and of reported delocalization.
std::vector<render::PlotSpan> spans_of(const RunContents& run);

/// Table of all events, folded.
render::CollapsibleTables event_table(const RunContents& run);

}  // namespace patrol::app
