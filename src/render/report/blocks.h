#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "render/report/map_picture.h"

/// What a report's page is made of: plain descriptions, which know nothing of runs, sweeps or HTML. Every text is plain; it is escaped
/// when the page is written.
namespace patrol::render {

enum class Tone { kPlain, kGood, kWarning, kBad, kFaint };

/// One colour, one meaning, through all figures of a page (report.css).
enum class Ink { kTruth, kEstimate, kBound, kOdometry, kRanges, kTrust, kEvent, kAlarm };

struct TableCell {
  std::string text;
  Tone tone = Tone::kPlain;
};

struct Column {
  std::string title;
  bool is_number = false;  ///< set flush right
};

struct TableBlock {
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<TableCell>> rows;
};

/// Tables that only some readers want: shown on demand, and in print.
struct FoldedTables {
  std::string summary;
  std::vector<TableBlock> tables;
};

struct TextBlock {
  std::string text;
};

/// How it went, and what that is made of.
struct VerdictBlock {
  std::string word;
  Tone tone = Tone::kPlain;
  std::string reason;
  TableBlock checks;
};

struct KeyFigure {
  std::string label;
  std::string value;
  std::string unit;
  std::string note;
};
struct KeyFigures {
  std::vector<KeyFigure> figures;
};

struct Bar {
  std::string label;
  double value = 0.0;
  std::string text;  ///< the value as it is to be read
};
struct BarBlock {
  std::string caption;
  std::vector<Bar> bars;
};

/// All values of one kind, and their quartiles.
struct Box {
  std::string label;
  std::vector<double> values;
  double lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0;
  std::string text;  ///< the median as it is to be read
};
struct BoxPlot {
  std::string caption;
  std::string unit;
  std::vector<Box> boxes;
};

/// A stretch of a scale, with an interval about its end: a step of a waterfall, or a difference from zero.
struct Span {
  std::string label;
  double from = 0.0, to = 0.0;
  std::optional<std::pair<double, double>> interval{};
  Tone tone = Tone::kPlain;
  std::string text;  ///< the figure as it is to be read
};
/// One below the other, on one scale, zero marked.
struct SpanChart {
  std::string caption;
  std::string unit;
  std::vector<Span> spans;
};

struct Curve {
  std::string name;
  Ink ink = Ink::kEstimate;
  bool is_dashed = false;
  std::vector<Eigen::Vector2d> points;  ///< x growing
};
struct PlotMark {
  double x = 0.0;
  std::string text;
  Ink ink = Ink::kEvent;
};
struct PlotSpan {
  double from = 0.0, to = 0.0;
  std::string text;
};
/// The x axis that several plots share: they are zoomed together.
struct PlotAxis {
  std::string label;
  double max = 1.0;  ///< from 0
};

struct LinePlot {
  std::string title;
  std::string unit;
  PlotAxis axis;
  std::optional<double> max;  ///< of y, where it has one
  std::vector<Curve> curves;
  std::vector<PlotMark> marks;
  std::vector<PlotSpan> spans;
};

/// What happened when, kind by kind.
struct LanePlot {
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
  Ink ink = Ink::kEstimate;
  std::vector<std::vector<Eigen::Vector2d>> pieces_m;  ///< polylines in the picture's frame
};
struct MapMark {
  std::string label;
  Ink ink = Ink::kEvent;
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< in the picture's frame
};
struct MapBlock {
  MapPicture picture;
  std::vector<MapPath> paths;
  std::vector<MapMark> marks;
};

/// An MP4: its bytes, or else where it lies, seen from the page.
struct VideoBlock {
  std::string mp4;
  std::string address;
  std::string caption;
};

using Block = std::variant<TextBlock, VerdictBlock, KeyFigures, TableBlock, FoldedTables, BarBlock, BoxPlot, SpanChart, LinePlot, LanePlot,
                           MapBlock, VideoBlock>;

/// Line plots that follow each other stand beside each other where there is room.
struct Section {
  std::string title;  ///< none: the first, which needs none
  std::vector<Block> blocks;
};

struct Page {
  std::string kind;   ///< e.g. "run"
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<Section> sections;
  std::string colophon;  ///< what the page was made of
};

}  // namespace patrol::render
