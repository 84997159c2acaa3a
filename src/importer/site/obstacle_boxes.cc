#include "importer/site/obstacle_boxes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace patrol::importer {
namespace {

constexpr double kStep_m = 0.01;  // of heights
constexpr int kBelow = 10;        // steps below the ground that a column begins
constexpr int kWords = 5;
constexpr int kBits = 64 * kWords;

/// Polygon of at most seven corners: a triangle clipped to a cell.
struct Polygon {
  std::array<Eigen::Vector3d, 8> corners;
  int size = 0;
};

/// Returns the part of the polygon on one side of a plane across an axis: sign * (x - bound) <= 0.
Polygon clipped(const Polygon& from, int axis, double bound, double sign) {
  Polygon to;
  for (int i = 0; i < from.size; ++i) {
    const Eigen::Vector3d& a = from.corners[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& b = from.corners[static_cast<std::size_t>((i + 1) % from.size)];
    const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
    if (da <= 0.0 && to.size < 8) to.corners[static_cast<std::size_t>(to.size++)] = a;
    if (((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) && to.size < 8)
      to.corners[static_cast<std::size_t>(to.size++)] = a + da / (da - db) * (b - a);
  }
  return to;
}

/// Occupied heights of one cell, in steps above a base.
struct Column {
  std::array<std::uint64_t, kWords> bits = {};

  bool get(int i) const { return (bits[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1u) != 0; }
  void set(int first, int last) {
    for (int i = first; i <= last; ++i) bits[static_cast<std::size_t>(i / 64)] |= std::uint64_t{1} << (i % 64);
  }
};

/// Run of occupied heights in a column, in steps; the end is excluded.
struct Run {
  int begin = 0;
  int end = 0;
  bool is_used = false;
};

class ObstacleColumns {
 public:
  ObstacleColumns(const GroundSurface& ground, double tolerance_m, double height_m)
      : ground_(ground), grid_(ground.height_m.geometry()), tolerance_m_(tolerance_m), height_m_(height_m) {
    columns_.resize(grid_.size());
  }

  void add(const Mesh& mesh) {
    for (const std::array<int, 3>& t : mesh.triangles) {
      Polygon triangle;
      triangle.size = 3;
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = mesh.vertices_m[static_cast<std::size_t>(t[k])];
      add(triangle);
    }
  }

  std::vector<Eigen::AlignedBox3d> boxes() {
    make_runs();
    std::vector<Eigen::AlignedBox3d> boxes;
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        for (std::size_t i = begin_[index(col, row)]; i < begin_[index(col, row) + 1]; ++i) {
          if (!runs_[i].is_used) boxes.push_back(grow(col, row, runs_[i]));
        }
      }
    }
    return boxes;
  }

 private:
  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) + static_cast<std::size_t>(col);
  }
  int base(std::size_t cell) const {
    return static_cast<int>(std::floor(double{ground_.height_m.values()[cell]} / kStep_m)) - kBelow;
  }
  double edge(int axis, int i) const { return grid_.origin_m[axis] + grid_.resolution_m * i; }

  void add(const Polygon& triangle) {
    Eigen::AlignedBox2d box;
    for (int k = 0; k < 3; ++k) box.extend(triangle.corners[static_cast<std::size_t>(k)].head<2>().eval());
    const Cell first = grid_.cell_at(box.min()), last = grid_.cell_at(box.max());
    if (first == last) {
      if (grid_.contains(first)) mark(first, triangle);
      return;
    }
    for (int row = std::max(0, first.row); row <= std::min(grid_.height - 1, last.row); ++row) {
      const Polygon band = clipped(clipped(triangle, 1, edge(1, row), -1.0), 1, edge(1, row + 1), 1.0);
      if (band.size == 0) continue;
      double left = band.corners[0].x(), right = left;
      for (int k = 1; k < band.size; ++k) {
        left = std::min(left, band.corners[static_cast<std::size_t>(k)].x());
        right = std::max(right, band.corners[static_cast<std::size_t>(k)].x());
      }
      const int first_col = std::max(0, grid_.cell_at({left, 0.0}).col);
      const int last_col = std::min(grid_.width - 1, grid_.cell_at({right, 0.0}).col);
      for (int col = first_col; col <= last_col; ++col) {
        const Polygon part = clipped(clipped(band, 0, edge(0, col), -1.0), 0, edge(0, col + 1), 1.0);
        if (part.size > 0) mark({col, row}, part);
      }
    }
  }

  void mark(Cell cell, const Polygon& part) {
    double lowest = part.corners[0].z(), highest = lowest, above = -1.0, below = 1e9;
    for (int k = 0; k < part.size; ++k) {
      const Eigen::Vector3d& p = part.corners[static_cast<std::size_t>(k)];
      const double over = p.z() - ground_.at(p.head<2>());
      above = std::max(above, over), below = std::min(below, over);
      lowest = std::min(lowest, p.z()), highest = std::max(highest, p.z());
    }
    if (above <= tolerance_m_ || below > height_m_) return;
    const std::size_t i = index(cell.col, cell.row);
    const int from = static_cast<int>(std::floor(std::max(lowest / kStep_m, -1e8) + 0.01)) - base(i);
    const int to = static_cast<int>(std::ceil(std::min(highest / kStep_m, 1e8) - 0.01)) - 1 - base(i);
    const int top = std::min(kBits - 1, kBelow + static_cast<int>(height_m_ / kStep_m));
    columns_[i].set(std::clamp(from, 0, top), std::clamp(std::max(from, to), 0, top));
  }

  void make_runs() {
    const int min_steps = static_cast<int>(std::lround(grid_.resolution_m / kStep_m));
    begin_.assign(grid_.size() + 1, 0);
    for (std::size_t cell = 0; cell < grid_.size(); ++cell) {
      begin_[cell] = runs_.size();
      const Column& column = columns_[cell];
      if (std::all_of(column.bits.begin(), column.bits.end(), [](std::uint64_t word) { return word == 0; })) continue;
      const int lowest = base(cell);
      for (int i = 0; i < kBits; ++i) {
        if (!column.get(i)) continue;
        int end = i;
        while (end < kBits && column.get(end)) ++end;
        const bool is_near = runs_.size() > begin_[cell] && lowest + i - runs_.back().end < min_steps;
        if (is_near) runs_.back().end = lowest + end;
        else runs_.push_back({.begin = lowest + i, .end = lowest + end});
        i = end;
      }
      for (std::size_t k = begin_[cell]; k < runs_.size(); ++k) {
        const int floor = k == begin_[cell] ? lowest - min_steps : runs_[k - 1].end;
        if (runs_[k].end - runs_[k].begin < min_steps) runs_[k].begin = std::max(floor, runs_[k].end - min_steps);
      }
    }
    begin_.back() = runs_.size();
    columns_ = {};
  }

  /// Unused run of a cell that can be merged with `box`; null if there is none.
  Run* partner(int col, int row, const Run& box) {
    const int max_steps = static_cast<int>(std::lround(grid_.resolution_m / kStep_m));
    for (std::size_t i = begin_[index(col, row)]; i < begin_[index(col, row) + 1]; ++i) {
      Run& run = runs_[i];
      if (!run.is_used && run.end == box.end && std::abs(run.begin - box.begin) <= max_steps) return &run;
    }
    return nullptr;
  }

  /// Merges a run with those of its neighbors along x, then whole rows along y.
  Eigen::AlignedBox3d grow(int col, int row, Run& first) {
    const Run compared = first;  // so that the bottom of the box is at most a cell below that of any column
    Run whole = first;
    first.is_used = true;
    const auto take = [&](Run* run) {
      whole.begin = std::min(whole.begin, run->begin);
      whole.end = std::max(whole.end, run->end);
      run->is_used = true;
    };
    int end_col = col + 1, end_row = row + 1;
    for (; end_col < grid_.width; ++end_col) {
      Run* run = partner(end_col, row, compared);
      if (run == nullptr) break;
      take(run);
    }
    std::vector<Run*> line;
    for (; end_row < grid_.height; ++end_row) {
      line.clear();
      for (int c = col; c < end_col; ++c) {
        Run* run = partner(c, end_row, compared);
        if (run == nullptr) break;
        line.push_back(run);
      }
      if (static_cast<int>(line.size()) < end_col - col) break;
      for (Run* run : line) take(run);
    }
    return {Eigen::Vector3d(edge(0, col), edge(1, row), whole.begin * kStep_m),
            Eigen::Vector3d(edge(0, end_col), edge(1, end_row), whole.end * kStep_m)};
  }

  const GroundSurface& ground_;
  GridGeometry grid_;
  double tolerance_m_;
  double height_m_;
  std::vector<Column> columns_;
  std::vector<std::size_t> begin_;  ///< [cell]
  std::vector<Run> runs_;
};

}  // namespace

std::vector<Eigen::AlignedBox3d> obstacle_boxes(const Mesh& mesh, const GroundSurface& ground, double tolerance_m,
                                                double height_m) {
  ObstacleColumns columns(ground, tolerance_m, height_m);
  columns.add(mesh);
  return columns.boxes();
}

}  // namespace patrol::importer
