"""Planted regressions. Each is an edit of one file: `old`, which occurs in it exactly once, becomes `new`. `targets` are built and
the tests that match `first` are run first; `first` is the part of the tests that should find the regression."""
import dataclasses


@dataclasses.dataclass
class Mutation:
    name: str
    summary: str
    file: str
    old: str
    new: str
    targets: tuple
    first: str  # regular expression of ctest

    def fault(self, root):
        """Reason why the edit cannot be made; none if it can."""
        path = root / self.file
        if not path.exists():
            return f"{self.name}: {self.file}: not found"
        count = path.read_text().count(self.old)
        return None if count == 1 else f"{self.name}: {self.file}: the text to replace occurs {count} times: must be once"

    def apply(self, root):
        path = root / self.file
        path.write_text(path.read_text().replace(self.old, self.new))


MUTATIONS = [
    Mutation("noise_zero", "the lidar's range noise is zero", "src/sim/sensors/lidar.cc",
             "got.range_m += settings_.range_noise_std_m * range_noise_.normal(tick, index);",
             "got.range_m += 0.0 * settings_.range_noise_std_m * range_noise_.normal(tick, index);",
             ("sim_test",), r"^Lidar\."),
    Mutation("truth_in_odometry", "the published odometry is the true motion", "src/app/run/run_loop.cc",
             "      write_published(log_, now, message);\n",
             "      if (const auto* odometry = std::get_if<OdometryEstimate>(&message.content.value())) {\n"
             "        OdometryEstimate leaked = *odometry;\n"
             "        leaked.T_odom_body = simulator_.truth().T_world_body;\n"
             "        log_.write(now, leaked);\n"
             "      } else {\n"
             "        write_published(log_, now, message);\n"
             "      }\n",
             ("patrol",), r"^(Scenario|Street|Substation|Tunnel)\."),
    Mutation("ate_halved", "the ATE is half of what it is", "src/score/pose/trajectory_error.cc",
             ".ate_rmse_m = root_mean_square(position_m),", ".ate_rmse_m = 0.5 * root_mean_square(position_m),",
             ("score_test",), r"^(TrajectoryError|RunScore|ScoreRun)\."),
    Mutation("collision_ignored", "the first contact with an object is no collision", "src/sim/simulator/simulator.cc",
             "      contacts_.emplace_back(object, now_);\n      collisions_.push_back(collision);\n",
             "      contacts_.emplace_back(object, now_);\n",
             ("sim_test",), r"^Simulator\."),
    Mutation("map_shifted", "published maps are 0.8 m off, and with them every station", "src/stack/stack.cc",
             "  output_.publish(std::move(update));\n",
             "  GridGeometry geometry = update.map.geometry();\n"
             "  geometry.origin_m.x() += 0.8;\n"
             "  MapUpdate shifted{now, OccupancyGrid(geometry)};\n"
             "  shifted.map.values() = update.map.values();\n"
             "  output_.publish(std::move(shifted));\n",
             ("patrol",), r"^(Scenario|Street|Substation|Tunnel)\."),
    Mutation("stream_shared", "two sensors draw from one random stream", "src/sim/sensors/ultrasonic.cc",
             'noise_(seed, "ultrasonic/noise")', 'noise_(seed, "uwb/noise")',
             (), r"^Core\.RandomStreams$"),
    Mutation("deskewing_off", "all beams of a scan are placed at the pose of the last", "src/localize/scan_leveler.cc",
             "T_odom_body_at(beam_time(scan, static_cast<double>(beam)));", "T_odom_body_at(beam_time(scan, last_beam + 0.0 * beam));",
             ("localize_test",), r"^ScanLeveler\."),
    Mutation("expectation_skipped", "every measured expectation is met", "src/app/scoring/expectations.cc",
             "check.is_met = *value >= expectation.min && *value <= expectation.max;", "check.is_met = true;",
             ("app_test",), r"^Expectations\."),
    Mutation("uwb_bias_sign", "the bias of UWB ranges has the other sign", "src/sim/sensors/uwb.cc",
             "range.range_m = distance_m + settings_.bias_scale * uwb_range_bias_m(distance_m, power_offset_db) +",
             "range.range_m = distance_m - settings_.bias_scale * uwb_range_bias_m(distance_m, power_offset_db) +",
             ("sim_test",), r"^Uwb\."),
    Mutation("seed_ignored", "every seed gives the draws of seed 1", "src/core/random.cc",
             ": seed_(seed), stream_(hash_of(name)) {}", ": seed_(seed > 0 ? 1 : 0), stream_(hash_of(name)) {}",
             ("core_test",), r"^RandomStream\."),
    Mutation("covariance_tight", "the published covariance of the pose is a hundredth of the estimated one",
             "src/stack/localization/slam_localizer.cc",
             "update.T_map_body, update.covariance + map_covariance_};",
             "update.T_map_body, 0.01 * (update.covariance + map_covariance_)};",
             ("patrol",), r"^(Scenario|Street|Substation|Tunnel)\."),
    Mutation("time_offset_sign", "the estimated time offset of the lidar is applied with the other sign",
             "src/stack/localization/pose_pipeline.cc",
             "corrected.stamp -= from_seconds(correction.time_offset_s);", "corrected.stamp += from_seconds(correction.time_offset_s);",
             ("patrol",), r"^ClockOffset\."),
    Mutation("clock_lag_in_margin", "the margin of the clock monitor contains the lag of odometry, so that 7 ms are not reported",
             "src/stack/sensors/clock_monitor.cc",
             ".noise_std_s = offset.noise_std_s", ".noise_std_s = offset.std_s",
             ("stack_test",), r"^ClockMonitor\."),
]
