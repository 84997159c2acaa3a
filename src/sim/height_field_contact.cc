#include "sim/height_field_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include <Eigen/Geometry>

namespace patrol::sim {
namespace {

constexpr double kSamePoint_m = 1e-9;

/// Triangle of a height field, with the point of it that is nearest to the sphere's center.
struct Facet {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d nearest;
  double distance_m;  ///< from `nearest` to the center
};

/// Returns the point of a triangle that is nearest to `p` [Ericson05, 5.1.5].
Eigen::Vector3d nearest_point(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& p) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double ab_ap = ab.dot(ap), ac_ap = ac.dot(ap), ab_bp = ab.dot(bp), ac_bp = ac.dot(bp), ab_cp = ab.dot(cp),
               ac_cp = ac.dot(cp);
  if (ab_ap <= 0.0 && ac_ap <= 0.0) return a;
  if (ab_bp >= 0.0 && ac_bp <= ab_bp) return b;
  if (ac_cp >= 0.0 && ab_cp <= ac_cp) return c;
  const double of_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (of_c <= 0.0 && ab_ap >= 0.0 && ab_bp <= 0.0) return a + ab_ap / (ab_ap - ab_bp) * ab;
  const double of_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (of_b <= 0.0 && ac_ap >= 0.0 && ac_cp <= 0.0) return a + ac_ap / (ac_ap - ac_cp) * ac;
  const double of_a = ab_bp * ac_cp - ab_cp * ac_bp;
  const double along_bc = ac_bp - ab_bp, along_cb = ab_cp - ac_cp;
  if (of_a <= 0.0 && along_bc >= 0.0 && along_cb >= 0.0) return b + along_bc / (along_bc + along_cb) * (c - b);
  const double sum = of_a + of_b + of_c;
  return a + of_b / sum * ab + of_c / sum * ac;
}

/// Height field of a model. Rows run along y, columns along x; each cell is split along the diagonal from (row, column)
/// to (row + 1, column + 1), as by MuJoCo.
class HeightField {
 public:
  HeightField(const mjModel& model, int hfield)
      : heights_(model.hfield_data + model.hfield_adr[hfield]),
        rows_(model.hfield_nrow[hfield]),
        columns_(model.hfield_ncol[hfield]),
        half_m_(model.hfield_size[4 * hfield], model.hfield_size[4 * hfield + 1]),
        height_m_(model.hfield_size[4 * hfield + 2]),
        cell_m_(2.0 * half_m_.x() / (columns_ - 1), 2.0 * half_m_.y() / (rows_ - 1)) {}

  /// Calls `visit` with every triangle that reaches into the box about `center`, except those entirely below it.
  template <typename Visit>
  void visit_triangles(const Eigen::Vector3d& center, double reach_m, Visit visit) const {
    const auto range = [&](Eigen::Index axis, int cells) {
      const double first = (center[axis] - reach_m + half_m_[axis]) / cell_m_[axis],
                   last = (center[axis] + reach_m + half_m_[axis]) / cell_m_[axis];
      return std::array{static_cast<int>(std::clamp(std::floor(first), 0.0, static_cast<double>(cells))),
                        static_cast<int>(std::clamp(std::floor(last) + 1.0, 0.0, static_cast<double>(cells)))};
    };
    const auto [first_column, last_column] = range(0, columns_ - 1);
    const auto [first_row, last_row] = range(1, rows_ - 1);
    const double lowest_m = center.z() - reach_m;
    for (int row = first_row; row < last_row; ++row) {
      for (int column = first_column; column < last_column; ++column) {
        const Eigen::Vector3d here = corner(row, column), right = corner(row, column + 1), up = corner(row + 1, column),
                              across = corner(row + 1, column + 1);
        if (std::max({here.z(), right.z(), across.z()}) >= lowest_m) visit(std::array{here, right, across});
        if (std::max({here.z(), across.z(), up.z()}) >= lowest_m) visit(std::array{here, across, up});
      }
    }
  }

 private:
  Eigen::Vector3d corner(int row, int column) const {
    return {column * cell_m_.x() - half_m_.x(), row * cell_m_.y() - half_m_.y(),
            static_cast<double>(heights_[row * columns_ + column]) * height_m_};
  }

  const float* heights_;  ///< [row][column], 0 ... 1
  int rows_, columns_;
  Eigen::Vector2d half_m_;
  double height_m_;
  Eigen::Vector2d cell_m_;
};

/// Returns whether a point is vertically below a triangle; `upward` is a normal of the triangle.
bool is_below(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& upward,
              const Eigen::Vector3d& center) {
  if (upward.dot(center - triangle[0]) > 0.0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = triangle[(i + 1) % 3] - triangle[i], offset = center - triangle[i];
    if (edge.x() * offset.y() - edge.y() * offset.x() < 0.0) return false;
  }
  return true;
}

/// Returns whether the nearest point of `facet` is a point of `other` too and not its nearest, or the nearest of both,
/// and `other` is the earlier one.
bool is_redundant(const Facet& facet, const Facet& other, bool is_earlier) {
  if (other.distance_m > facet.distance_m + kSamePoint_m) return false;
  if ((nearest_point(other.corners, facet.nearest) - facet.nearest).norm() > kSamePoint_m) return false;
  const bool is_same_point = (other.nearest - facet.nearest).norm() <= kSamePoint_m;
  return is_same_point ? is_earlier : true;
}

int collide(const mjModel* model, mjData* data, mjPreContact* contacts, int field, int sphere, mjtNum margin) {
  using Matrix = Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>;
  const Eigen::Map<const Eigen::Vector3d> p_field(data->geom_xpos + 3 * field), p_sphere(data->geom_xpos + 3 * sphere);
  const Eigen::Map<const Matrix> R_field(data->geom_xmat + 9 * field);
  const Eigen::Vector3d center = R_field.transpose() * (p_sphere - p_field);
  int count = 0;
  for (const SphereContact& found :
       contacts_with_height_field(*model, model->geom_dataid[field], center, model->geom_size[3 * sphere], margin)) {
    if (count == mjMAXCONPAIR) break;
    mjPreContact& contact = contacts[count++];
    contact = {};
    contact.dist = found.distance_m;
    const Eigen::Vector3d middle = p_field + R_field * (found.point + found.distance_m / 2.0 * found.normal);
    const Eigen::Vector3d normal = R_field * found.normal;
    std::copy_n(middle.data(), 3, contact.pos);
    std::copy_n(normal.data(), 3, contact.normal);
  }
  return count;
}

}  // namespace

std::vector<SphereContact> contacts_with_height_field(const mjModel& model, int hfield, const Eigen::Vector3d& center,
                                                      double radius_m, double margin_m) {
  std::vector<SphereContact> contacts;
  std::vector<Facet> near;
  const double reach_m = radius_m + margin_m;
  HeightField(model, hfield).visit_triangles(center, reach_m, [&](const std::array<Eigen::Vector3d, 3>& triangle) {
    const Eigen::Vector3d upward = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const double height = upward.dot(center - triangle[0]);  // above the plane, times the length of `upward`
    if (height > 0.0 && height * height > reach_m * reach_m * upward.squaredNorm()) return;
    if (is_below(triangle, upward, center)) {
      const Eigen::Vector3d normal = upward.normalized();
      const double height_m = normal.dot(center - triangle[0]);
      contacts = {{center - height_m * normal, normal, height_m - radius_m}};
    }
    const Eigen::Vector3d nearest = nearest_point(triangle, center);
    const double distance_m = (center - nearest).norm();
    if (distance_m < reach_m && center.z() > nearest.z()) near.push_back({triangle, nearest, distance_m});
  });
  if (!contacts.empty()) return contacts;
  for (std::size_t i = 0; i < near.size(); ++i) {
    bool is_needed = true;
    for (std::size_t j = 0; j < near.size() && is_needed; ++j)
      is_needed = j == i || !is_redundant(near[i], near[j], j < i);
    if (!is_needed) continue;
    contacts.push_back(
        {near[i].nearest, (center - near[i].nearest) / near[i].distance_m, near[i].distance_m - radius_m});
  }
  return contacts;
}

void use_closed_form_sphere_contacts() {
  static std::once_flag once;
  std::call_once(once, [] { mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_SPHERE] = collide; });
}

}  // namespace patrol::sim
