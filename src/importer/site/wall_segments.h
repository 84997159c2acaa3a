#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"

namespace patrol::importer {

/// Straight piece of a wall: its visible face from `begin_m` to `end_m`, in the frame of the plan.
struct WallSegment {
  Eigen::Vector2d begin_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d end_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit normal of the face, toward the free side
  double thickness_m = 0.0;                           ///< thickness of the wall behind the face
};

/// Settings of `WallFitter`.
struct WallFitterSettings {
  double max_offset_m = 0.015;       ///< maximum distance of a cell's surface from its segment
  double max_turn_rad = 0.15;        ///< maximum angle between the surface of a cell and its segment
  double max_gap_m = 0.11;           ///< maximum distance along the segment between cells with hits
  double half_weight_range_m = 5.0;  ///< range at which a hit has half the weight of a near one
  double min_weight = 2.0;           ///< minimum weight of the hits of a cell
  double max_thickness_m = 0.04;     ///< thickness of a wall of which no other side is seen
};

/// Fits straight faces of walls to the hits of a lidar in the occupied cells of a plan. Positions are finer than the
/// cells: the face of a cell is the mean of its hits, its direction that of the hits around. The two faces of a thin
/// wall are kept apart by the directions from which they are seen. A wall with two faces is at most as thick as their
/// distance, so that none of the two sticks out of the other.
class WallFitter {
 public:
  /// Throws InputError for an empty plan.
  explicit WallFitter(const OccupancyGrid& plan, const WallFitterSettings& settings = {});

  /// Adds a hit, seen from `p_sensor_m`; both in the frame of the plan. Hits beside occupied cells have no effect.
  void add(const Eigen::Vector2d& p_hit_m, const Eigen::Vector2d& p_sensor_m);

  /// Returns the segments that cover all occupied cells with enough hits, the longest first. Cells without a straight
  /// neighborhood become segments of one cell.
  std::vector<WallSegment> segments() const;

  /// Occupied cells without enough hits, which no segment covers.
  bool is_uncovered(Cell cell) const;

 private:
  static constexpr int kSectors = 8;  ///< sectors of the direction from a hit to the sensor

  /// Weighted sums of hits.
  struct Moments {
    double weight = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();       ///< sum of positions, relative to the origin of the plan
    Eigen::Matrix2d products = Eigen::Matrix2d::Zero();  ///< sum of outer products of the same positions

    void add(const Moments& other);
  };
  /// Surface of a cell.
  struct Surfel {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< position relative to the origin of the plan
    Eigen::Vector2d along = Eigen::Vector2d::UnitX();
    Eigen::Vector2d normal = Eigen::Vector2d::UnitY();
    double weight = 0.0;
    bool is_straight = false;
    Cell cell = {};
  };

  /// Line through surfaces.
  struct Line {
    Eigen::Vector2d center;
    Eigen::Vector2d along;          ///< unit vector
    double begin = 0.0, end = 0.0;  ///< ends along the line, from the center, m
  };

  Moments moments_around(Cell cell, int reach_cells, const Eigen::Vector2d* normal, double min_cosine = 0.0) const;
  std::vector<Surfel> surfels() const;
  double thickness_behind(const WallSegment& segment) const;
  static Line fit(const std::vector<std::size_t>& members, const std::vector<Surfel>& surfels,
                  const Eigen::Vector2d& along);
  bool fits(const Line& line, const Surfel& surfel) const;
  std::optional<std::size_t> next_at(double tip, const Line& line, const Eigen::Vector2d& facing,
                                     const std::vector<Surfel>& surfels, const Grid<int>& first_of,
                                     const std::vector<char>& is_used) const;
  WallSegment grow(std::size_t seed, const std::vector<Surfel>& surfels, const Grid<int>& first_of,
                   std::vector<char>& is_used) const;

  GridGeometry grid_;
  WallFitterSettings settings_;
  Grid<int> slot_of_;                                ///< index of the sums of an occupied cell; -1: not occupied
  std::vector<std::array<Moments, kSectors>> sums_;  ///< [slot][sector]
};

}  // namespace patrol::importer
