/// Unknowns without a pivot at the root: null vectors, multipliers of least norm, consistency.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

/// Combinations of the columns that are orthonormal after rows are multiplied by `weight`. The second sweep removes
/// errors of the first that are due to the condition of the columns.
void orthonormalise(std::vector<double>& vectors, int count, const Eigen::VectorXd& weight) {
  Eigen::Map<Eigen::MatrixXd> V(vectors.data(), weight.size(), count);
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int k = 0; k < count; ++k) V.col(k) /= weight.cwiseProduct(V.col(k)).norm();
    V = divide_by_triangular(V, triangular_factor(weight.asDiagonal() * V));
  }
}

/// Whether the constraint forces of a vector (scaled) cancel at every node: G^T y = 0 against |G|^T |y|, in the units
/// of the scene. If rows are truly dependent they do, for any masses. Behind a light body between heavy ones they do
/// not, although in scaled variables, in which the light body moves much, the singular value is only the ratio of the
/// masses. A thirtieth of the forces at a node is tolerated, and 3e-5 of the largest, for loops that are still open by
/// 1e-5, as rank_tolerance allows.
/// precision: of the data; forces then cancel to it, relative to the largest.
bool forces_cancel(const ElementStore& elements, const tree::Tree& tree, const bool* is_constraint,
                   const std::vector<double>& column_scale, double precision, const double* z) {
  std::vector<double> sum(at(tree.num_unknowns()), 0.0), magnitude(sum.size(), 0.0);
  std::vector<std::size_t> unknowns;
  for (const int e : tree.element_order) {
    unknowns.clear();
    bool has_constraint = false;
    for (int k = 0; k < elements.num_blocks_of(e); ++k) {
      const auto block = at(elements.blocks_of(e)[k]);
      has_constraint |= is_constraint[at(tree.unknown_begin[block])];
      for (auto u = tree.unknown_begin[block]; u < tree.unknown_begin[block + 1]; ++u) unknowns.push_back(at(u));
    }
    if (!has_constraint) continue;
    const ConstElementView a = elements.view(e);
    const std::size_t n = unknowns.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (is_constraint[unknowns[i]]) continue;
      for (std::size_t j = 0; j < n; ++j) {
        if (!is_constraint[unknowns[j]]) continue;
        const double force = a[static_cast<std::int64_t>(i * n + j)] * column_scale[unknowns[j]] * z[unknowns[j]];
        sum[unknowns[i]] += force;
        magnitude[unknowns[i]] += std::abs(force);
      }
    }
  }
  const double most = *std::max_element(magnitude.begin(), magnitude.end());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (!(std::abs(sum[i]) <= passing_force * std::max(magnitude[i], insignificant_force * most))) return false;
    if (precision > 0.0 && !(std::abs(sum[i]) <= units_of_precision * precision * most)) return false;
  }
  return true;
}

}  // namespace

/// Right vectors z by back-substitution and left vectors y with L, with the k remaining rows and columns of the root
/// set to one unit vector after the other. Then y_i^T A z_j is the remaining block of the root.
void Hierarchical::State::eval_null_candidates() {
  const FrontData& root = fronts.back();
  const int k = root.num_delayed();
  const std::size_t n = at(tree.num_unknowns());
  null_space.took_vectors = true;
  null_space.right.assign(at(k) * n, 0.0);
  null_space.left.assign(at(k) * n, 0.0);
  correction.resize(n);
  x = correction.data();  // there is no present solution
  for (int v = 0; v < k; ++v) {
    for (FrontData& d : fronts) std::fill(d.vector, d.vector + d.pivots, 0.0);
    for (int i = 0; i < k; ++i) {
      const std::size_t u = at(root.columns[root.pivots + i]);
      x[u] = i == v ? scales.column[u] : 0.0;
    }
    std::fill(lane_vectors.begin(), lane_vectors.end(), 0.0);
    for (auto g = static_cast<int>(lanes.groups.size()); g-- > 0;) backward_group(g);
    double* right = null_space.right.data() + at(v) * n;
    for (std::size_t i = 0; i < n; ++i) right[i] = x[i] / scales.column[i];
    std::vector<double>& left = residual;  // unscaled: R times the scaled one
    const std::size_t row = at(root.rows[root.pivots + v]);
    left[row] = scales.row[row];
    for (int i = 0; i < k; ++i)
      if (i != v) left[at(root.rows[root.pivots + i])] = 0.0;
    for (const tree::FrontId f : null_space.dependent_fronts)
      for (int i = data(f).full - data(f).dependent; i < data(f).full; ++i) left[at(data(f).rows[i])] = 0.0;
    for (auto g = static_cast<int>(lanes.groups.size()); g-- > 0;) {
      const LaneGroup& group = lanes.groups[at(g)];
      if (group.in_lanes) {
        for (int f = group.front_end; f-- > group.front_begin;) {
          backward_left_lane_front(f, left);
          for (int l = 0; scalar_lanes[at(f)] != 0 && l < lanes_wide; ++l)
            if ((scalar_lanes[at(f)] >> l & 1) != 0) backward_left_front(lanes.fronts[at(f)].front[at(l)], left);
        }
        continue;
      }
      const tree::Subdomain& s = tree.subdomains[at(group.subdomains.front())];
      for (tree::FrontId f = s.front_end; f-- > s.front_begin;) backward_left_front(f, left);
    }
    double* scaled = null_space.left.data() + at(v) * n;
    for (std::size_t i = 0; i < n; ++i) scaled[i] = left[i] / scales.row[i];
  }
  project_candidates();
}

/// Makes the root's vectors orthogonal to those of the fronts, in the weighted norm and in the plain one.
void Hierarchical::State::project_candidates() {
  if (null_space.local_right.num_vectors() == 0) return;
  find_local_left_vectors();
  const std::size_t n = at(tree.num_unknowns());
  for (int v = 0; v < fronts.back().num_delayed(); ++v) {
    double *z = null_space.right.data() + at(v) * n, *y = null_space.left.data() + at(v) * n;
    null_space.local_right.project([&](int u) { return z[u] * scales.weight[at(u)] * scales.weight[at(u)]; },
                                   [&](int u, double part) { z[u] -= part; });
    null_space.local_left.project([&](int u) { return y[u]; }, [&](int u, double part) { y[u] -= part; });
  }
}

/// Left vectors of a front on the scalar path: reads its boundary from `left`, unscaled, and writes its own part there.
void Hierarchical::State::backward_left_front(tree::FrontId f, std::vector<double>& left) {
  FrontData& d = data(f);
  with_vector(d, [&](double* z) {
    for (int i = 0; i < d.full; ++i) z[i] = i < d.pivots ? 0.0 : left[at(d.rows[i])] / scales.row[at(d.rows[i])];
    for_boundary(f, [&](int i, std::size_t u) { z[d.full + i] = left[u] / scales.row[u]; });
    substitute_backward_left(d.matrix(), d.pivots, z);
    for (int i = 0; i < d.pivots; ++i) left[at(d.rows[i])] = z[i] * scales.row[at(d.rows[i])];
  });
}

/// The remaining block T of the root is small, and needs a scale. With Z = Q_z R_z and Y = Q_y R_y the smallest
/// singular values of A are, nearly, those of R_y^-T T R_z^-1: the distances to singular matrices. Directions without
/// motion are dependent rows below rank_tolerance if their forces cancel as well, others make the matrix singular below
/// singular_tolerance; all others are eliminated.
void Hierarchical::State::decide_rank() {
  FrontData& root = fronts.back();
  const int m = root.num_delayed();
  if (m == 0) return;
  eval_null_candidates();
  const std::size_t n = at(tree.num_unknowns());
  using Matrix = Eigen::MatrixXd;
  const auto rows = static_cast<Eigen::Index>(n);
  const Eigen::Map<const Matrix> Z(null_space.right.data(), rows, m), Y(null_space.left.data(), rows, m);
  const Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> T(
      root.a + root.pivots + static_cast<std::ptrdiff_t>(root.pivots) * root.lda, m, m, Eigen::OuterStride<>(root.lda));
  const Matrix R_z = triangular_factor(Z), R_y = triangular_factor(Y);
  const Matrix core = solve_triangular_transposed(R_z, solve_triangular_transposed(R_y, T).transpose()).transpose();
  const Matrix basis = Z * solve_triangular(R_z, Matrix::Identity(m, m));  // Q_z
  const auto motion_share = [&](const Matrix& unit_vectors) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      if (!is_constraint[i]) sum += unit_vectors.row(static_cast<Eigen::Index>(i)).squaredNorm();
    return std::sqrt(sum);
  };
  const auto cancels = [&](const Eigen::VectorXd& z) {
    return forces_cancel(elements, tree, is_constraint.get(), scales.column, options.data_precision, z.data());
  };
  const auto all_cancel = [&] {
    for (int j = 0; j < m; ++j)
      if (!cancels(basis.col(j))) return false;
    return true;
  };
  const double tolerance = std::max(options.rank_tolerance, uncertain_entry());
  int dependent = 0;
  if (core.norm() <= tolerance && motion_share(basis) <= options.null_motion_tolerance && all_cancel()) {
    dependent = m;  // the usual case: only dependent constraint rows
  } else {
    const RightSingularVectors singular = right_singular_vectors(core);
    for (int j = 0; j < m; ++j) {
      const Eigen::VectorXd z = basis * singular.vectors.col(j);
      const bool is_of_constraints = motion_share(z) <= options.null_motion_tolerance && cancels(z);
      if (!(singular.values(j) > (is_of_constraints ? tolerance : options.singular_tolerance))) ++dependent;
    }
  }
  if (dependent == m) return;
  std::vector<double> row_weight(at(m)), column_weight(at(m));
  for (int j = 0; j < m; ++j) {
    row_weight[at(j)] = 1.0 / Y.col(j).norm();
    column_weight[at(j)] = 1.0 / Z.col(j).norm();
  }
  FrontMatrix matrix = root.matrix();
  root.pivots = eliminate_completely(matrix, root.pivots, root.full - dependent, std::numeric_limits<double>::min(),
                                     row_weight.data(), column_weight.data());
}

/// Orthonormal null vectors of the remaining unknowns, and the resulting status.
void Hierarchical::State::find_null_space() {
  const int k = fronts.back().num_delayed();
  null_space.dimension = k;
  status.deficiency = null_space.deficiency();
  if (k == 0) return;
  const std::size_t n = at(tree.num_unknowns());
  if (null_space.right.size() != at(k) * n) eval_null_candidates();  // decide_rank() has eliminated some of its own
  orthonormalise(null_space.right, k,
                 Eigen::Map<const Eigen::VectorXd>(scales.weight.data(), static_cast<Eigen::Index>(n)));
  orthonormalise(null_space.left, k, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(n)));
  // A null vector with motion: a part of the structure is not held.
  double worst = 0.0;
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_constraint[i]) continue;
    double share = 0.0;
    for (int v = 0; v < k; ++v) share += std::pow(null_space.right[at(v) * n + i], 2);
    if (share > worst) {
      worst = share;
      unknown = i;
    }
  }
  if (!(std::sqrt(worst) <= options.null_motion_tolerance)) {
    status.outcome = FactorOutcome::singular;
    status.front = tree.num_fronts() - 1;
    status.block = tree.block_of_unknown(static_cast<std::int64_t>(unknown));
    status.local = static_cast<int>(static_cast<std::int64_t>(unknown) - tree.unknown_begin[at(status.block)]);
    status.magnitude = std::sqrt(worst);
  }
}

void Hierarchical::State::project_multipliers() {
  const std::size_t n = at(tree.num_unknowns());
  for (int v = 0; v < null_space.dimension; ++v) {
    const double* z = null_space.right.data() + at(v) * n;
    double c = 0.0;
    for (std::size_t i = 0; i < n; ++i) c += x[i] / scales.column[i] * z[i] * scales.weight[i] * scales.weight[i];
    // Includes the small motion of the null vector; without it the equations would not be satisfied.
    for (std::size_t i = 0; i < n; ++i) x[i] -= c * z[i] * scales.column[i];
  }
  null_space.local_right.project(
      [&](int u) { return x[u] / scales.column[at(u)] * scales.weight[at(u)] * scales.weight[at(u)]; },
      [&](int u, double part) { x[u] -= part * scales.column[at(u)]; });
}

/// If rows are dependent, the matrix of the solution is A_k, A with zero instead of the remaining block T of the root:
/// its null vectors are exact, and its solutions are those of A except for T x in the remaining rows. The residual is
/// that of A_k; |T x|, the error by the decision on the rank, is reported separately. T is the singular value that was
/// taken to be zero, times the lengths of the null vectors in units of the remaining rows and columns, which are long
/// if a direction has small components there.
ElementStore::Errors Hierarchical::State::eval_met_residual(const tree::Walker& walker, SolveReport& report) {
  ElementStore::Errors errors = elements.eval_residual(walker, scales, x, given, residual.data());
  leave_out_zeros(errors, report);
  return errors;
}

void Hierarchical::State::leave_out_zeros(ElementStore::Errors& errors, SolveReport& report) {
  if (null_space.deficiency() == 0 || !errors.finite || !(errors.size > 0.0)) return;
  const FrontData& root = fronts.back();
  const int k = root.num_delayed();
  double left_out = add_negligible_part(), met = 0.0;
  for (int i = 0; i < k; ++i) {
    double sum = 0.0;
    for (int j = 0; j < k; ++j) {
      const auto column = at(root.columns[root.pivots + j]);
      sum += root.a[root.pivots + i + static_cast<std::ptrdiff_t>(root.pivots + j) * root.lda] * x[column] /
             scales.column[column];
    }
    const auto row = at(root.rows[root.pivots + i]);
    residual[row] += sum / scales.row[row];
    left_out = std::max(left_out, std::abs(sum));
  }
  for (std::size_t i = 0; i < residual.size(); ++i) met = std::max(met, std::abs(scales.row[i] * residual[i]));
  report.rank_error = left_out / errors.size;
  errors.set_normwise(met);
}

/// Subtracts from the right-hand side its part in the left null space. Dependent rows that contradict each other have
/// no solution: the nearest right-hand side that has one is solved.
void Hierarchical::State::make_consistent(SolveReport& report) {
  if (null_space.deficiency() == 0) return;
  const std::size_t n = at(tree.num_unknowns());
  const double* b = rhs.data();
  find_local_left_vectors();
  std::vector<double>& part = correction;  // Y Y^T b
  part.assign(n, 0.0);
  double whole = 0.0, left = 0.0;
  for (std::size_t i = 0; i < n; ++i) whole += std::pow(scales.row[i] * b[i], 2);
  for (int v = 0; v < null_space.dimension; ++v) {
    const double* y = null_space.left.data() + at(v) * n;
    double c = 0.0;
    for (std::size_t i = 0; i < n; ++i) c += y[i] * scales.row[i] * b[i];
    for (std::size_t i = 0; i < n; ++i) part[i] += c * y[i];
  }
  null_space.local_left.project([&](int u) { return scales.row[at(u)] * b[u] - part[at(u)]; },
                                [&](int u, double amount) { part[at(u)] += amount; });
  for (const double p : part) left += p * p;
  report.inconsistency = whole > 0.0 ? std::sqrt(left / whole) : 0.0;
  double worst = 0.0;
  for (int blk = 0; blk + 1 < static_cast<int>(tree.unknown_begin.size()); ++blk) {
    const std::size_t begin = at(tree.unknown_begin[at(blk)]), end = at(tree.unknown_begin[at(blk) + 1]);
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += part[i] * part[i];
    if (sum == 0.0) continue;
    for (std::size_t i = begin; i < end; ++i) part[i] /= scales.row[i];
    for (std::size_t i = begin; i < end; ++i) rhs[i] -= part[i];
    if (sum <= worst) continue;
    worst = sum;
    report.inconsistent_block = blk;
    report.inconsistent_amount = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      report.inconsistent_amount = std::max(report.inconsistent_amount, std::abs(part[i]));
  }
}

}  // namespace bough::solve
