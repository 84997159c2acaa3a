#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "slam/graph/likelihood_pyramid.h"
#include "slam/graph/scan_group.h"
#include "slam/grid_map.h"
#include "slam/match_points.h"
#include "slam/scan_integration.h"

namespace patrol::slam {

/// Stored scans with the tracked pose of the newest.
struct Keyframe {
  ScanGroup scans;
  Pose2 T_local_body;
};

/// Range of consecutive keyframes that forms a submap; its frame is that of the first keyframe.
struct Submap {
  int first = 0;  ///< index of the first keyframe, which is its node in the pose graph
  int last = 0;   ///< index of the last keyframe, inclusive
};

/// Settings for rendering scans into a map.
struct MapRenderingSettings {
  double resolution_m = 0.05;
  double max_extent_m = 4000.0;  ///< side of the mapped square around the origin
  ScanIntegrationSettings integration = {};
};

/// Submap rendered for matching: grid map, surface points and likelihood pyramid.
class RenderedSubmap {
 public:
  /// Renders the keyframes of `submap` at `T_map_node` [keyframe].
  RenderedSubmap(const Submap& submap, const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node,
                 const MapRenderingSettings& rendering);

  const GridMap& map() const { return map_; }
  /// Downsampled surfaces (surface_points.h), used to match this submap with another.
  const std::vector<MatchPoint>& surface_points() const { return surface_points_; }
  double point_spacing_m() const { return 2.0 * map_.resolution_m(); }
  const LikelihoodPyramid& pyramid() const { return pyramid_; }
  /// Poses at which the keyframes of the submap were rendered.
  const std::vector<Pose2>& T_map_node() const { return T_map_node_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(map_, surface_points_, pyramid_, T_map_node_);
  }

 private:
  GridMap map_;
  std::vector<MatchPoint> surface_points_;
  LikelihoodPyramid pyramid_;
  std::vector<Pose2> T_map_node_;
};

/// Cache of the most recently used rendered submaps.
class SubmapCache {
 public:
  explicit SubmapCache(std::size_t capacity) : capacity_(capacity) {}

  template <typename Render>
  std::shared_ptr<const RenderedSubmap> get(int submap, Render&& render);
  void clear() { entries_.clear(); }

  /// Saves the poses at which the submaps were rendered, or renders them again: `render(submap, poses)`.
  template <typename Archive, typename Render>
  void serialize_state(Archive& archive, Render&& render) {
    const std::size_t size = archive.size_of(entries_.size());
    if (archive.is_loading()) entries_.assign(size, {});
    for (Entry& entry : entries_) {
      std::vector<Pose2> T_map_node;
      if (!archive.is_loading()) T_map_node = entry.rendered->T_map_node();
      archive(entry.submap, T_map_node);
      if (archive.is_loading()) entry.rendered = render(entry.submap, T_map_node);
    }
  }

 private:
  struct Entry {
    int submap = 0;
    std::shared_ptr<const RenderedSubmap> rendered = nullptr;
  };
  std::size_t capacity_;
  std::vector<Entry> entries_;  ///< in order of use, the newest last
};

template <typename Render>
std::shared_ptr<const RenderedSubmap> SubmapCache::get(int submap, Render&& render) {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (entry->submap != submap) continue;
    const Entry found = *entry;
    entries_.erase(entry);
    entries_.push_back(found);
    return found.rendered;
  }
  if (entries_.size() >= capacity_) entries_.erase(entries_.begin());
  entries_.push_back({submap, render()});
  return entries_.back().rendered;
}

}  // namespace patrol::slam
