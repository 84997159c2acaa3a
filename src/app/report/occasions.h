#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

/// What happened on a run, for plots and tables.
namespace patrol::app {

/// One lane for each kind of event, in the order of their first; then collisions and kidnaps.
std::vector<render::LanePlot::Lane> lanes_of(const RunContents& run);

/// Of the lanes, what error curves should be read against: troubles, recoveries, and where the robot found itself again.
std::vector<render::PlotMark> marks_of(const RunContents& run);

/// Faults, and how long the robot said that it was lost.
std::vector<render::PlotSpan> spans_of(const RunContents& run);

/// All events, folded.
render::FoldedTables event_table(const RunContents& run);

}  // namespace patrol::app
