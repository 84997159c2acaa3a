#include "sim/simulator/mujoco_state.h"

#include <cstdint>
#include <stdexcept>

#include <mujoco/mjxmacro.h>

#include "core/state/state_archive.h"

namespace patrol::sim {
namespace {

/// Throws std::runtime_error if a stored size differs from the present one.
void check_size(std::uint64_t size, StateArchive& archive) {
  std::uint64_t stored = size;
  archive(stored);
  if (stored != size) throw std::runtime_error("the simulated world has other parts");
}

/// Saves or restores a pointer into the arena.
template <typename T>
void serialize_arena_pointer(T*& pointer, std::byte* arena, StateArchive& archive) {
  constexpr std::int64_t kNull = -1;
  std::int64_t offset = pointer == nullptr ? kNull : reinterpret_cast<std::byte*>(pointer) - arena;
  archive(offset);
  pointer = offset == kNull ? nullptr : reinterpret_cast<T*>(arena + offset);
}

/// Saves or restores contacts, constraints and solver. MuJoCo computes them from the other fields, and leaves parts of
/// their memory uninitialized that it does not read.
void serialize_arena(mjData& data, StateArchive& archive) {
  auto* arena = static_cast<std::byte*>(data.arena);
  archive.raw(arena, data.parena);
#define X(type, name, rows, columns) serialize_arena_pointer(data.name, arena, archive);
#undef XNV
#define XNV X
  MJDATA_ARENA_POINTERS
#undef XNV
#undef X
}

}  // namespace

void serialize_state(const mjModel& model, mjData& data, StateArchive& archive) {
  archive.section("physics");
  check_size(model.signature, archive);
  check_size(data.nbuffer, archive);
  check_size(data.narena, archive);
  archive.raw(static_cast<std::byte*>(data.buffer), static_cast<std::size_t>(data.nbuffer));

  archive(data.pstack, data.pbase, data.parena, data.maxuse_stack, data.maxuse_arena, data.maxuse_con, data.maxuse_efc,
          data.ncon, data.ne, data.nf, data.nl, data.nefc, data.nJ, data.nA, data.nisland, data.nidof, data.ntree_awake,
          data.nbody_awake, data.nparent_awake, data.nv_awake, data.flg_energypos, data.flg_energyvel,
          data.flg_subtreevel, data.flg_rnepost, data.time);
  archive(data.efm_active, data.nefmK, data.nefmcon, data.nefmT, data.nefmA, data.nefmdof, data.nefmL, data.nY);
  archive.raw(data.solver_niter, std::size(data.solver_niter));
  archive.raw(data.solver_nnz, std::size(data.solver_nnz));
  archive.raw(data.solver_fwdinv, std::size(data.solver_fwdinv));
  archive.raw(data.warning, std::size(data.warning));
  archive.raw(data.energy, std::size(data.energy));

  if (!archive.is_comparing()) serialize_arena(data, archive);
}

void serialize_state(mjModel& physics, StateArchive& archive) {
  archive.section("model");
  const auto num_bodies = static_cast<std::size_t>(physics.nbody), num_geoms = static_cast<std::size_t>(physics.ngeom);
  archive(physics.opt.noslip_iterations);
  archive.raw(physics.body_contype, num_bodies);
  archive.raw(physics.body_conaffinity, num_bodies);
  archive.raw(physics.dof_frictionloss, static_cast<std::size_t>(physics.nv));
  if (physics.flg_surfacevel) archive.raw(physics.geom_surfacevel, 6 * num_geoms);
}

}  // namespace patrol::sim
