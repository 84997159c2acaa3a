#include "sim/tem/subsurface_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "core/random.h"
#include "sim/tem/conductive_sheet.h"
#include "sim/tem/laplace_inversion.h"
#include "sim/tem/permeability.h"
#include "sim/tem/tunnel_air.h"

namespace patrol::sim {
namespace {

constexpr int kSpheroidOrder = 12;  // 1e-5 of the response at twice the longer semi-axis

Eigen::Vector3d direction(double azimuth_deg, double elevation_deg) {
  return quaternion_from_rpy(0.0, -elevation_deg * kDegree, azimuth_deg * kDegree) * Eigen::Vector3d::UnitX();
}

ConductiveSpheroid spheroid_of(const WaterBodySettings& body) {
  const double equatorial_m = body.radius_m / std::cbrt(body.aspect_ratio);
  return {.polar_m = body.aspect_ratio * equatorial_m,
          .equatorial_m = equatorial_m,
          .conductivity_spm = body.conductivity_spm};
}

void check_distance(const WaterBodySettings& body, double distance_m, double min_distance_m) {
  if (distance_m > min_distance_m) return;
  throw InputError(
      fmt::format("water_bodies: body at ({}, {}, {}): must not contain the antenna", body.x_m, body.y_m, body.z_m));
}

/// Returns the mean over coil axes of a tensor with an axis of symmetry.
double mean_over_axes(const AxialTensor<double>& tensor, const Eigen::Vector3d& axis, const Eigen::Matrix3d& axes) {
  return tensor.across * axes.trace() + (tensor.along - tensor.across) * axis.dot(axes * axis);
}

}  // namespace

Subsurface sample_subsurface(Subsurface subsurface, std::uint64_t seed) {
  RockSettings& rock = subsurface.rock;
  validate(rock, "rock");
  rock.conductivity_spm *= std::exp(rock.conductivity_log_std * RandomStream(seed, "subsurface/rock").normal(0));
  const RandomStream bodies(seed, "subsurface/water_bodies");
  std::uint64_t index = 0;
  for (WaterBodySettings& body : subsurface.water_bodies)
    body.conductivity_spm *= std::exp(body.conductivity_log_std * bodies.normal(0, index++));
  return subsurface;
}

SubsurfaceResponse::SubsurfaceResponse(Subsurface subsurface, const TemGates& gates)
    : subsurface_(std::move(subsurface)), gates_(gates) {
  const RockSettings& rock = subsurface_.rock;
  if (rock.tunnel_radius_m > 0.0) {
    for (const double time_s : gates_.node_s())
      air_.push_back(tunnel_air_response(rock.conductivity_spm, rock.tunnel_radius_m, time_s));
  }
  for (const WaterBodySettings& body : subsurface_.water_bodies) {
    std::vector<SpheroidScattering>& scattering = spheroid_.emplace_back();
    if (body.shape == "sphere") continue;
    for (const double time_s : gates_.node_s()) {
      for (const LaplaceNode& node : laplace_nodes())
        scattering.emplace_back(rock.conductivity_spm, spheroid_of(body), node.st / time_s, kSpheroidOrder);
    }
  }
}

Eigen::VectorXd SubsurfaceResponse::gated_rate(const Eigen::Vector3d& p_world_m, const Eigen::Matrix3d& axes) const {
  Eigen::VectorXd rate = gated_whole_space_response(gates_, subsurface_.rock.conductivity_spm);
  for (std::size_t body = 0; body < spheroid_.size(); ++body) rate += body_rate(body, p_world_m, axes);
  if (!air_.empty()) rate += air_rate(axes);
  if (subsurface_.rock.fault_zone.conductance_s > 0.0) rate += fault_zone_rate(p_world_m, axes);
  return rate;
}

Eigen::VectorXd SubsurfaceResponse::body_rate(std::size_t index, const Eigen::Vector3d& p_world_m,
                                              const Eigen::Matrix3d& axes) const {
  const WaterBodySettings& body = subsurface_.water_bodies[index];
  const Eigen::Vector3d offset = Eigen::Vector3d(body.x_m, body.y_m, body.z_m) - p_world_m;
  const double rock_spm = subsurface_.rock.conductivity_spm;
  if (body.shape == "sphere") {
    const ConductiveSphere sphere{
        .distance_m = offset.norm(), .radius_m = body.radius_m, .conductivity_spm = body.conductivity_spm};
    check_distance(body, sphere.distance_m, 1.02 * sphere.radius_m);
    const GatedSphereResponse decay = gated_sphere_response(gates_, rock_spm, sphere);
    const double cos_squared = offset.dot(axes * offset) / offset.squaredNorm();
    return decay.transverse + cos_squared * (decay.axial - decay.transverse);
  }
  const ConductiveSpheroid spheroid = spheroid_of(body);
  check_distance(body, offset.norm(), 1.2 * std::max(spheroid.polar_m, spheroid.equatorial_m));
  const Eigen::Quaterniond R_body_world =
      rotation_between(direction(body.axis_azimuth_deg, body.axis_elevation_deg), Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d p_body_m = R_body_world * -offset;
  const Eigen::Matrix3d R = R_body_world.toRotationMatrix(), axes_in_body = R * axes * R.transpose();
  const auto nodes = laplace_nodes();
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(gates_.node_s().size()));
  std::size_t frequency = 0;
  for (Eigen::Index i = 0; i < rate.size(); ++i) {
    for (const LaplaceNode& node : nodes) {
      const Eigen::Matrix3cd field = spheroid_[index][frequency++].field_at_dipole(p_body_m);
      rate[i] += (node.weight * (field.cwiseProduct(axes_in_body)).sum()).imag();
    }
    rate[i] *= kPermeability / gates_.node_s()[static_cast<std::size_t>(i)];
  }
  return gates_.gated(rate);
}

Eigen::VectorXd SubsurfaceResponse::fault_zone_rate(const Eigen::Vector3d& p_world_m,
                                                    const Eigen::Matrix3d& axes) const {
  const FaultZoneSettings& zone = subsurface_.rock.fault_zone;
  const Eigen::Vector3d normal = direction(zone.normal_azimuth_deg, zone.normal_elevation_deg);
  const double distance_m = std::abs(normal.dot(Eigen::Vector3d(zone.x_m, zone.y_m, zone.z_m) - p_world_m));
  constexpr double kMinDistance_m = 1.0;
  if (distance_m < kMinDistance_m) {
    throw InputError(
        fmt::format("rock.fault_zone: {:.2f} m from the antenna: must be at least {} m", distance_m, kMinDistance_m));
  }
  Eigen::VectorXd rate(static_cast<Eigen::Index>(gates_.node_s().size()));
  for (Eigen::Index i = 0; i < rate.size(); ++i) {
    const double time_s = gates_.node_s()[static_cast<std::size_t>(i)];
    rate[i] = mean_over_axes(sheet_response(subsurface_.rock.conductivity_spm, zone.conductance_s, distance_m, time_s),
                             normal, axes);
  }
  return gates_.gated(rate);
}

Eigen::VectorXd SubsurfaceResponse::air_rate(const Eigen::Matrix3d& axes) const {
  const Eigen::Vector3d tunnel = direction(subsurface_.rock.tunnel_azimuth_deg, 0.0);
  Eigen::VectorXd rate(static_cast<Eigen::Index>(air_.size()));
  for (Eigen::Index i = 0; i < rate.size(); ++i)
    rate[i] = mean_over_axes(air_[static_cast<std::size_t>(i)], tunnel, axes);
  return subsurface_.rock.tunnel_air_fraction * gates_.gated(rate);
}

}  // namespace patrol::sim
