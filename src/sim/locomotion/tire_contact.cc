#include "sim/locomotion/tire_contact.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/gravity.h"

namespace patrol::sim {
namespace {

constexpr double kImpedance = 0.1;         // of the constraint in MuJoCo's contact: low for a spring
constexpr double kMaxPhase_rad = 0.25;     // of the oscillation of a tire in a time step
constexpr double kFrictionRatio = 1000.0;  // impratio

/// Sets spring and damper for a deflection under a load (MuJoCo documentation, "Computation", "Reference"). With the
/// regularization R of the contact, the spring is k / R and the damper b / R.
void set_spring(double deflection_m, double load_n, double damping_ratio, int geom, mjModel& physics) {
  const double inverse_mass = physics.body_invweight0[2 * physics.geom_bodyid[geom]];
  const double load_mps2 = (1.0 - kImpedance) / kImpedance * inverse_mass * load_n;  // R times the load
  const double stiffness = load_mps2 / deflection_m;
  const double damping = 2.0 * damping_ratio * load_mps2 / std::sqrt(kGravity_mps2 * deflection_m);
  physics.geom_solref[mjNREF * geom] = -kImpedance * stiffness;
  physics.geom_solref[mjNREF * geom + 1] = -kImpedance * damping;
  physics.geom_solimp[mjNIMP * geom] = physics.geom_solimp[mjNIMP * geom + 1] = kImpedance;
}

/// Scales the radius of a wheel; its bounding volumes never shrink.
void scale_radius(double scale, int geom, mjModel& physics) {
  for (int axis = 0; axis < 2; ++axis) {
    physics.geom_size[3 * geom + axis] *= scale;
    physics.geom_aabb[6 * geom + 3 + axis] *= std::max(1.0, scale);
  }
  physics.geom_rbound[geom] *= std::max(1.0, scale);
}

}  // namespace

void set_tires(const RobotDescription& robot, const WheelDriveSettings& settings, const WheelErrors& errors,
               mjModel& physics) {
  const double load_n = robot.mass_kg * kGravity_mps2 / static_cast<double>(robot.wheels.size());
  // The spring under its load has the angular frequency sqrt(g / deflection).
  const double min_deflection_m = kGravity_mps2 * std::pow(physics.opt.timestep / kMaxPhase_rad, 2);
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const WheelGeometry& wheel = robot.wheels[i];
    const int geom = mj_name2id(&physics, mjOBJ_GEOM, wheel.link.c_str());
    if (geom < 0) throw InputError("robot " + robot.name + ": the physics model lacks the wheel " + wheel.link);
    const double deflection_ratio = std::max(settings.tire_deflection_ratio, min_deflection_m / wheel.radius_m);
    const double deflection_m = deflection_ratio * wheel.radius_m;
    set_spring(deflection_m, load_n, settings.tire_damping_ratio, geom, physics);
    const double as_built_scale = errors.radius_scale.empty() ? 1.0 : errors.radius_scale[i];
    scale_radius(as_built_scale * (1.0 + 0.5 * deflection_ratio), geom, physics);
    physics.geom_friction[3 * geom] = settings.friction * errors.friction_scale;
    physics.dof_frictionloss[physics.body_dofadr[physics.geom_bodyid[geom]]] +=
        settings.rolling_resistance * load_n * wheel.radius_m;
  }
  physics.opt.impratio = kFrictionRatio;
}

}  // namespace patrol::sim
