#include "plan/perception/low_obstacles.h"

#include <algorithm>

namespace patrol::plan {
namespace {

/// Increments a count up to twice the threshold, so that a single image or ping does not toggle the obstacle.
int raised(int count, int confirmations) { return std::min(count + 1, 2 * confirmations); }
int lowered(int count) { return std::max(count - 1, 0); }

}  // namespace

void LowObstacles::add_image(const std::vector<Cell>& obstacles, const std::vector<Cell>& ground,
                             const std::vector<bool>& may_move, Time now) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Key key = to_key(obstacles[i]);
    Evidence& evidence = cells_[key];
    evidence.camera = raised(evidence.camera, settings_.confirmations);
    evidence.camera_until = now + from_seconds(may_move[i] ? settings_.dynamic_persistence_s : settings_.persistence_s);
    update_obstacle(key, evidence);
  }
  for (const Cell cell : ground) {
    const Key key = to_key(cell);
    Evidence& evidence = cells_[key];
    evidence.camera = lowered(evidence.camera);
    evidence.sonar = 0;
    evidence.ground_observed = now;
    update_obstacle(key, evidence);
  }
}

void LowObstacles::add_ping(const std::vector<Cell>& arc, const std::vector<Cell>& free, Time now) {
  for (const Cell cell : arc) {
    const Key key = to_key(cell);
    Evidence& evidence = cells_[key];
    if (!is_cleared_by_camera(evidence, now)) evidence.sonar = raised(evidence.sonar, settings_.confirmations);
    evidence.sonar_until = now + from_seconds(settings_.sonar_persistence_s);
    update_obstacle(key, evidence);
  }
  for (const Cell cell : free) {
    const auto found = cells_.find(to_key(cell));
    if (found == cells_.end()) continue;
    found->second.sonar = lowered(found->second.sonar);
    update_obstacle(found->first, found->second);
  }
}

void LowObstacles::clear_expired(Time now) {
  for (auto it = cells_.begin(); it != cells_.end();) {
    Evidence& evidence = it->second;
    if (now > evidence.camera_until) evidence.camera = 0;
    if (now > evidence.sonar_until) evidence.sonar = 0;
    update_obstacle(it->first, evidence);
    const bool is_uninformative = evidence.camera == 0 && evidence.sonar == 0 && !is_cleared_by_camera(evidence, now);
    it = is_uninformative ? cells_.erase(it) : std::next(it);
  }
}

bool LowObstacles::is_cleared_by_camera(const Evidence& evidence, Time now) const {
  if (evidence.ground_observed == Time::min()) return false;
  return now - evidence.ground_observed <= from_seconds(settings_.camera_clearing_s);
}

void LowObstacles::update_obstacle(const Key& key, Evidence& evidence) {
  const int sure = settings_.confirmations;
  // Hysteresis: an obstacle of the camera stays until its count is zero.
  const bool by_camera = evidence.camera >= sure || (evidence.is_obstacle && evidence.camera > 0);
  const bool is_obstacle = by_camera || evidence.sonar >= sure;
  if (is_obstacle == evidence.is_obstacle) return;
  evidence.is_obstacle = is_obstacle;
  if (is_obstacle) {
    ++num_obstacles_;
  } else {
    --num_obstacles_;
  }
  changed_.push_back(to_cell(key));
}

bool LowObstacles::is_obstacle(Cell cell) const {
  const auto found = cells_.find(to_key(cell));
  return found != cells_.end() && found->second.is_obstacle;
}

std::vector<Cell> LowObstacles::obstacles() const {
  std::vector<Cell> cells;
  for (const auto& [key, evidence] : cells_) {
    if (evidence.is_obstacle) cells.push_back(to_cell(key));
  }
  return cells;
}

}  // namespace patrol::plan
