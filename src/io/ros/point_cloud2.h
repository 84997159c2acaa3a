#pragma once

#include <string_view>

#include "core/sensors/lidar3d.h"

namespace patrol::io {

/// Reads a serialized sensor_msgs/PointCloud2 of any driver, with float32 fields `x`, `y` and `z`. Points that are not
/// finite are left out.
///
/// Times of the points are read from a field `time`, `t`, `timestamp`, `time_stamp` or `offset_time`: uint32 in
/// nanoseconds, float32 or float64 in seconds, relative to the header's stamp or, from 10^6 s on, absolute. `stamp` is
/// the earliest point, `time_s` counts from there. Without such a field, or if its times are not finite or span more
/// than a second, all times are zero and `stamp` is that of the header. Throws DecodeError if the fields do not fit the
/// data.
PointCloud decode_point_cloud(std::string_view bytes);

}  // namespace patrol::io
