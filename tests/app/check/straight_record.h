#pragma once

#include "app/check/drive_record.h"

namespace patrol::test {

/// Record of a straight drive at a constant speed. Wheels or tracks travel at `travel_mps`.
inline app::DriveRecord straight_record(double speed_mps, double travel_mps, double duration_s) {
  app::DriveRecord record;
  for (double time_s = 0.0; time_s < duration_s + 0.5 * app::kSamplePeriod_s; time_s += app::kSamplePeriod_s) {
    app::DriveSample sample;
    sample.time_s = time_s;
    sample.T_start_center.x = sample.ground_travel_m = speed_mps * time_s;
    sample.speed_mps = speed_mps;
    sample.commanded_speed_mps = travel_mps;
    sample.left_travel_m = sample.right_travel_m = travel_mps * time_s;
    record.samples.push_back(sample);
  }
  record.segment_ends = {record.samples.size()};
  return record;
}

}  // namespace patrol::test
