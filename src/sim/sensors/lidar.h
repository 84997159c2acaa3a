#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/background_worker.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/as_built/sensor_errors.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// Lidar model. Fires each beam at its own instant from the robot's pose at that instant. Each error source has its own
/// random stream, indexed by revolution and beam, so that one can be removed without changing the others.
///
/// Mixed pixels: if the range changes by 0.1 to 1.5 m between consecutive beams, the second beam is spread over both
/// surfaces and returns an intermediate range. Over a larger change the receiver separates the two returns and keeps
/// that of the beam axis. Not modeled: the beam width elsewhere, multiple returns, sunlight.
class Lidar {
 public:
  /// One ring yields scans, several yield clouds. `name` is the prefix of the random streams; `own_housing` is the
  /// housing that contains the beam origin and is ignored. Dust reduces the range and causes false returns. Messages
  /// state the nominal revolution rate. A worker, which must outlive this, measures the beams.
  Lidar(const LidarSettings& settings, const LidarScene& scene, Pose3 T_body_lidar, RayMask own_housing,
        std::uint64_t seed, const std::string& name, const DustSettings& dust = {}, const LidarErrors& errors = {},
        BackgroundWorker* worker = nullptr);
  ~Lidar();
  Lidar(const Lidar&) = delete;
  Lidar& operator=(const Lidar&) = delete;

  /// Fires the beams whose instants are in (from, to]; the body pose is interpolated in between.
  void advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to);

  /// Readings of one revolution: a scan, or a cloud of several rings.
  struct Revolution {
    LaserScan scan;
    PointCloud cloud;
    std::vector<double> last_range_m;  ///< [ring], range of the last beam without noise
  };
  /// Revolution whose beams have been fired, and may still be measured by the worker.
  struct FiredRevolution {
    BackgroundWorker::Ticket ticket = 0;
    std::shared_ptr<Revolution> revolution;  ///< revolution with the stamp of its message
  };

  /// Removes and returns the revolutions completed since the last call.
  std::vector<FiredRevolution> take_fired() { return std::exchange(fired_, {}); }
  /// Waits until the beams of a revolution are measured.
  Revolution& measured(const FiredRevolution& fired) const;
  /// Remove and return the revolutions completed since the last call, when they are measured.
  std::vector<LaserScan> take_scans();
  std::vector<PointCloud> take_clouds();
  bool has_rings() const { return settings_.rings > 1; }

  /// Precondition: the completed revolutions have been taken.
  template <typename Archive>
  void serialize_state(Archive& archive) {
    submit();
    if (worker_) worker_->wait(submitted_);
    archive(next_beam_, revolution_begin_ns_, revolution_ns_, rate_error_, *revolution_);
  }

 private:
  struct Return {
    double range_m;  ///< range, REP 117
    double intensity;
  };

  struct Beam {
    std::int64_t number;  ///< number of the beam since the start
    Time instant;
    Pose3 T_world_lidar;
  };
  /// Beams of one tick.
  struct Shots {
    std::shared_ptr<const LidarScene::Poses> bodies;
    std::vector<Beam> beams;
  };

  Time instant_of(std::int64_t beam) const;
  void submit();
  void finish_revolution();
  void fire(const Shots& shots, Revolution& revolution) const;
  RayCone cone_of(std::span<const Beam> beams) const;
  Eigen::Vector3d direction(std::size_t column, std::size_t ring) const;
  std::size_t column_of(const Beam& beam) const { return static_cast<std::size_t>(beam.number % settings_.beams); }
  std::uint64_t tick_of(const Beam& beam) const { return static_cast<std::uint64_t>(beam.number / settings_.beams); }
  Eigen::Vector3d aimed(const Beam& beam, std::size_t ring) const;
  Return to_return(const std::optional<RayHit>& hit, const Eigen::Vector3d& direction) const;
  Return measure(const Beam& beam, std::size_t ring, const LidarScene::Targets& targets, const Eigen::Vector3d& aimed,
                 const Return& ideal, double& last_range_m) const;
  Return mixed_pixel_return(const LidarScene::Targets& targets, const Pose3& T_world_lidar,
                            const Eigen::Vector3d& direction, const Return& middle) const;
  void record(const Beam& beam, std::size_t ring, const Return& got, Revolution& revolution) const;
  void begin_revolution();
  void update_rate();

  LidarSettings settings_;
  const LidarScene& scene_;
  Pose3 T_body_lidar_;
  std::uint32_t mask_;
  DustSettings dust_;
  LidarErrors errors_;
  LidarAim aim_;
  double min_incidence_cosine_;          ///< cosine of the angle of incidence below which beams are lost
  std::vector<SurfaceOptics> surfaces_;  ///< [geom] of the view model
  double false_return_rate_per_m_;       ///< rate of false returns from rain and dust
  RandomStream range_noise_, is_wide_, wide_noise_, angle_noise_, dropout_, rain_, rain_range_, rate_noise_;
  std::int64_t next_beam_ = 0;                              ///< number of the next beam since the start
  double revolution_begin_ns_ = 0.0, revolution_ns_ = 0.0;  ///< begin and duration of the revolution of the next beam
  double rate_error_ = 0.0;                                 ///< relative error of the revolution rate
  std::vector<Eigen::Vector2d> azimuth_;                    ///< [beam], cosine and sine of the azimuth
  std::vector<double> instants_;                            ///< [beam], fraction of the revolution
  std::vector<Eigen::Vector2d> elevation_;                  ///< [ring], cosine and sine of the elevation
  std::shared_ptr<Revolution> revolution_ = std::make_shared<Revolution>();
  std::vector<Shots> shots_;   ///< beams that are not yet submitted, [tick]
  std::size_t max_beams_ = 0;  ///< maximum number of beams in a tick, for memory only
  BackgroundWorker* worker_;
  BackgroundWorker::Ticket submitted_ = 0;
  std::vector<FiredRevolution> fired_;
};

}  // namespace patrol::sim
