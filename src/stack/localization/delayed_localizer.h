#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "core/background_worker.h"
#include "stack/localization/localizer.h"

namespace patrol::stack {

/// Correction of the pose by a scan.
struct PoseCorrection {
  Time due{};  ///< instant at which it takes effect
  Time stamp{};
  Pose2 T_odom_body;           ///< odometry at the stamp
  PoseEstimate estimate = {};  ///< pose estimate at the stamp
  StackOutput output = {};     ///< messages of the localizer
};

/// Localizer whose corrections take effect a fixed time after their scans arrived, as on a robot, where SLAM computes
/// beside odometry and control. Until then the pose follows odometry. The delay applies to SLAM only: a localizer on a
/// given map corrects the pose at once.
///
/// With a thread, the corrections are computed beside the owner, with the same results.
class DelayedLocalizer {
 public:
  DelayedLocalizer(std::unique_ptr<Localizer> localizer, Time delay, bool has_thread);

  /// Begins the correction by a scan that arrived at `received`. `T_odom_body` is at the scan's stamp.
  void begin_update(const LevelScan& scan, const Pose2& T_odom_body, Time received);
  /// Removes and returns the next correction that takes effect at `now` or before; none if none is due.
  std::optional<PoseCorrection> take_due(Time now);
  /// Adds a UWB range or a position, after the scans before it.
  template <typename Measurement>
  void add(const Measurement& measurement) {
    execute([localizer = localizer_.get(), measurement] { localizer->add(measurement); });
  }

  // SLAM does not change these properties by itself, so that they are known beside a computation.
  bool is_mapping() const { return localizer_->is_mapping(); }
  bool is_lost() const { return localizer_->is_lost(); }
  bool has_pose() const { return localizer_->has_pose(); }

  /// Returns the localizer after it has processed everything that was given to it, due or not.
  Localizer& wait();

  void serialize_state(StateArchive& archive);

 private:
  struct Pending {
    BackgroundWorker::Ticket ticket = 0;
    std::unique_ptr<PoseCorrection> correction;  ///< its address is fixed: the worker writes to it
  };

  BackgroundWorker::Ticket execute(std::function<void()> task);

  std::unique_ptr<Localizer> localizer_;
  Time delay_;
  std::deque<Pending> pending_;               ///< in the order of their scans
  BackgroundWorker::Ticket last_ticket_ = 0;  ///< ticket of the last task of the worker
  std::unique_ptr<BackgroundWorker> worker_;  ///< last member: its thread ends before the others do
};

}  // namespace patrol::stack
