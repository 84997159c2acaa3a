#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "report/map_picture.h"

/// Content of a report page as plain data, independent of runs, sweeps and HTML. All texts are plain text and are
/// escaped when the page is written.
namespace patrol::report {

/// Emphasis of a text or bar.
enum class Tone { kPlain, kGood, kWarning, kBad, kFaint };

/// Meanings of colors in all figures of a page (report.css).
enum class SeriesColor { kTruth, kEstimate, kBound, kOdometry, kRanges, kConfidence, kEvent, kAlarm };

struct TableCell {
  std::string text;
  Tone tone = Tone::kPlain;
};

struct Column {
  std::string title;
  bool is_number = false;  ///< right-aligned
};

struct TableBlock {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<TableCell>> rows;
};

/// Collapsible tables: closed on screen until opened, open in print.
struct CollapsibleTables {
  std::string summary;
  std::vector<TableBlock> tables;
};

struct TextBlock {
  std::string text;
};

/// Verdict of a run with its reason and the checks behind it.
struct VerdictBlock {
  std::string word;
  Tone tone = Tone::kPlain;
  std::string reason;
  TableBlock checks;
};

struct KeyMetric {
  std::string label;
  std::string value;
  std::string unit;
  std::string note;
};
struct KeyMetrics {
  std::vector<KeyMetric> metrics;
};

struct Bar {
  std::string label;
  double value = 0.0;
  std::string text;  ///< displayed value
};
struct BarBlock {
  std::string caption;
  std::vector<Bar> bars;
};

/// Values of one group with their quartiles.
struct Box {
  std::string label;
  std::vector<double> values;
  double lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0;
  std::string text;  ///< displayed median
};
struct BoxPlot {
  std::string caption;
  std::string unit;
  std::vector<Box> boxes;
};

/// Interval of a scale with a confidence interval about its end: a step of a waterfall chart, or a difference from
/// zero.
struct Span {
  std::string label;
  double from = 0.0, to = 0.0;
  std::optional<std::pair<double, double>> interval{};
  Tone tone = Tone::kPlain;
  std::string text;  ///< displayed value
};
/// Rows of spans on a common scale with a mark at zero.
struct WaterfallChart {
  std::string caption;
  std::string unit;
  std::vector<Span> spans;
};

struct Curve {
  std::string name;
  SeriesColor color = SeriesColor::kEstimate;
  bool is_dashed = false;
  std::vector<Eigen::Vector2d> points;  ///< increasing x
};
struct PlotMark {
  double x = 0.0;
  std::string text;
  SeriesColor color = SeriesColor::kEvent;
};
struct PlotSpan {
  double from = 0.0, to = 0.0;
  std::string text;
};
/// x axis shared by several plots, which zoom together.
struct PlotAxis {
  std::string label;
  double max = 1.0;
  double min = 0.0;
};

struct LinePlot {
  std::string title;
  std::string unit;
  PlotAxis axis;
  std::optional<double> max;  ///< upper limit of the y axis, if fixed
  std::vector<Curve> curves;
  std::vector<PlotMark> marks;
  std::vector<PlotSpan> spans;
};

/// Timeline of events with one lane per kind.
struct EventTimeline {
  struct Lane {
    std::string name;
    std::vector<PlotMark> marks;
  };
  std::string title;
  PlotAxis axis;
  std::vector<Lane> lanes;
  std::vector<PlotSpan> spans;
};

struct MapPath {
  std::string name;
  SeriesColor color = SeriesColor::kEstimate;
  std::vector<std::vector<Eigen::Vector2d>> pieces_m;  ///< polylines, in the picture's frame
};
struct MapMark {
  std::string label;
  SeriesColor color = SeriesColor::kEvent;
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< position, in the picture's frame
};
struct MapBlock {
  MapPicture picture;
  std::vector<MapPath> paths;
  std::vector<MapMark> marks;
  std::string error_name = {};  ///< meaning of the colors of the errors; empty: distance to the nearest true surface
};

/// Signed values on a grid, in colors from negative over zero to positive.
struct HeatMap {
  struct Cell {
    int column = 0, row = 0;
    double value = 0.0;
  };
  /// Outlined cell with a text beside it.
  struct Mark {
    int column = 0, row = 0;
    std::string text;
  };
  struct ColumnNote {
    int column = 0;
    std::string text;
    Tone tone = Tone::kPlain;
  };
  std::string caption;
  std::string unit;
  std::string negative, positive;  ///< meanings of the signs, in the legend
  double max = 1.0;                ///< absolute value with the full color
  std::string column_title;
  std::vector<std::string> columns;  ///< label of each column
  std::vector<std::string> rows;     ///< label of each row from the top, often empty
  std::vector<Cell> cells;           ///< a cell that is missing has no value
  std::vector<Mark> marks;
  std::string notes_title;
  std::vector<ColumnNote> notes;  ///< below the column labels
};

/// Paths and marks in a plane, with meters on both axes at the same scale.
struct PlanView {
  std::string caption;
  std::string x_title, y_title;
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero(), high_m = Eigen::Vector2d::Zero();  ///< limits of the axes
  std::vector<MapPath> paths;
  std::vector<MapMark> marks;
};

/// MP4 video: embedded bytes, or a URL relative to the page.
struct VideoBlock {
  std::string mp4;
  std::string url;
  std::string caption;
};

/// Rendered picture with the pixels of a PNG.
struct PictureBlock {
  std::string png;
  std::string caption;
  int width_px = 640, height_px = 400;  ///< size of the picture
};

using Block =
    std::variant<TextBlock, VerdictBlock, KeyMetrics, TableBlock, CollapsibleTables, BarBlock, BoxPlot, WaterfallChart,
                 LinePlot, EventTimeline, MapBlock, HeatMap, PlanView, VideoBlock, PictureBlock>;

/// Section of a page. Consecutive line plots form a grid.
struct Section {
  std::string title;  ///< empty only for the first section
  std::vector<Block> blocks;
};

struct Page {
  std::string kind;  ///< e.g. "run"
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< label and value in the page's header
  std::vector<Section> sections;
  std::string footer;  ///< program version and sources of the page
};

}  // namespace patrol::report
