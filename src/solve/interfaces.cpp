/// Quantities of the method: interface flexibility, its condition, and the textbook condensation through it.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

using Matrix = Eigen::MatrixXd;
using ConstMap = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;
using Map = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

}  // namespace

/// |diagonal| of the sub-domain's own elements at its interface, scaled; if only its joints hold a motion unknown, the
/// diagonal of the whole matrix, 1; for multipliers 0.
std::vector<double> Hierarchical::State::interface_stiffness(tree::SubdomainId s) const {
  const tree::Subdomain& sub = tree.subdomains[at(s)];
  const tree::Front& top = front(sub.top());
  const auto boundary = tree.boundary_blocks(top);
  std::vector<std::pair<int, int>> row_of;  // (block, first row)
  int rows = 0;
  for (int b : boundary) {
    row_of.push_back({b, rows});
    rows += elements.graph().block_size[at(b)];
  }
  std::sort(row_of.begin(), row_of.end());
  std::vector<double> stiffness(at(rows), 0.0);
  for (int e : tree.elements(sub)) {
    const ConstElementView a = elements.view(e);
    const std::int64_t n = elements.size_of(e);
    std::int64_t k = 0;
    for (int p = 0; p < elements.num_blocks_of(e); ++p) {
      const int b = elements.blocks_of(e)[p], size = elements.graph().block_size[at(b)];
      const auto it = std::lower_bound(row_of.begin(), row_of.end(), std::pair<int, int>{b, 0});
      if (it != row_of.end() && it->first == b)
        for (int i = 0; i < size; ++i) {
          const std::size_t u = at(tree.unknown_begin[at(b)] + i);
          if (!is_constraint[u])
            stiffness[at(it->second + i)] += std::abs(a[(k + i) * n + k + i]) * scales.row[u] * scales.column[u];
        }
      k += size;
    }
  }
  constexpr double round_off = 1e-12;  // joints alone give round-off there, not always zero
  int row = 0;
  for (int b : boundary)
    for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u, ++row)
      if (stiffness[at(row)] < round_off && !is_constraint[at(u)]) stiffness[at(row)] = 1.0;
  return stiffness;
}

/// S <- s^2 F^-1 - P with F = s^2 (S + P)^-1: mathematically exact, but in floating point S is lost beside a large P.
/// For comparison only.
void Hierarchical::State::condense_through_flexibility(tree::SubdomainId s) {
  FrontData& d = data(tree.subdomains[at(s)].top());
  AugmentedInterface& interface = augmented[at(s)];
  const int n = d.size - d.full;
  interface.used = false;
  if (d.failed || n == 0 || d.num_delayed() > 0) return;
  interface.penalty = interface_stiffness(s);
  const Eigen::Map<Eigen::VectorXd> penalty(interface.penalty.data(), n);
  Eigen::Map<Eigen::VectorXd>(interface.penalty.data(), n) *= options.penalty_factor;
  Map S(d.s, n, n, Eigen::OuterStride<>(d.lds));
  const double s2 = options.multiplier_scale * options.multiplier_scale;
  Matrix stiffened = S;
  stiffened.diagonal() += penalty;
  const Matrix F = s2 * inverse(stiffened), stiffness = inverse(F);
  if (!F.allFinite() || !stiffness.allFinite()) return;
  S = s2 * stiffness;
  S.diagonal() -= penalty;
  interface.flexibility.assign(F.data(), F.data() + F.size());
  interface.inverse.assign(stiffness.data(), stiffness.data() + stiffness.size());
  interface.work.resize(at(n));
  interface.used = true;
}

/// g <- s^2 F^-1 (F g / s^2): the load that the textbook form condenses.
void Hierarchical::State::correct_forward(tree::SubdomainId s) {
  AugmentedInterface& interface = augmented[at(s)];
  if (!interface.used) return;
  FrontData& d = data(tree.subdomains[at(s)].top());
  const int n = d.size - d.full;
  Eigen::Map<Eigen::VectorXd> g(d.vector + d.full, n), moved(interface.work.data(), n);
  moved.noalias() = Eigen::Map<const Matrix>(interface.flexibility.data(), n, n) * g;
  g.noalias() = Eigen::Map<const Matrix>(interface.inverse.data(), n, n) * moved;
}

/// Copies the Schur complement that the visit of a front has left, in scaled variables, to n x n entries by columns.
void Hierarchical::State::copy_schur(tree::FrontId f, double* to) {
  const bool is_in_lane = !is_scalar(f);
  const int n = front(f).num_boundary;
  Map S(to, n, n, Eigen::OuterStride<>(n));
  bool is_triangle = data(f).is_symmetric();
  if (is_in_lane) {
    const LaneFront& common = lanes.fronts[at(lanes.lane_front[at(f)])];
    const double* schur = schur_of(common) + lanes.lane[at(f)];
    is_triangle = common.is_symmetric;
    for_boundary(f, [&](int j, std::size_t column) {
      for_boundary(f, [&](int i, std::size_t row) {
        const std::int64_t entry = static_cast<std::int64_t>(j) * common.boundary + i;
        S(i, j) = scales.row[row] * schur[entry * lanes_wide] * scales.column[column];
      });
    });
  } else {
    S = ConstMap(data(f).s, n, n, Eigen::OuterStride<>(data(f).lds));
  }
  if (is_triangle) S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
}

/// At the end of the visit of a sub-domain.
InterfaceReport Hierarchical::State::report_interface(tree::SubdomainId s, int widest) {
  const tree::Subdomain& sub = tree.subdomains[at(s)];
  const tree::FrontId top = sub.top();
  const int n = front(top).num_boundary;
  InterfaceReport report{.subdomain = s, .level = sub.level, .num_unknowns = n};
  report.flops = sub.flops;
  if (is_scalar(top)) report.num_delayed = data(top).num_delayed();
  if (n > widest) report.condition = std::numeric_limits<double>::quiet_NaN();
  if (n == 0 || n > widest || (is_scalar(top) && data(top).failed)) return report;
  const std::vector<double> stiffness = interface_stiffness(s);
  Matrix stiffened(n, n);
  copy_schur(top, stiffened.data());
  std::vector<int> motion;
  for (int i = 0; i < n; ++i) {
    stiffened(i, i) += options.penalty_factor * stiffness[at(i)];
    if (stiffness[at(i)] > 0.0) motion.push_back(i);
  }
  const std::optional<Matrix> flexibility = solve_if_regular(stiffened, Matrix::Identity(n, n));
  if (!flexibility) return report;  // rows that are empty here belong to unknowns that are held further up
  const auto size = static_cast<Eigen::Index>(motion.size());
  Matrix scaled(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) {
      const int k = motion[at(i)], l = motion[at(j)];
      scaled(i, j) = (*flexibility)(k, l) * options.penalty_factor * std::sqrt(stiffness[at(k)] * stiffness[at(l)]);
    }
  if (motion.empty() || !scaled.allFinite()) return report;
  const Eigen::VectorXd values = singular_values(scaled);
  Eigen::Index last = values.size() - 1;  // directions that joints hold at the interface itself have no flexibility
  while (last > 0 && values(last) <= 1e-13 * values(0)) --last;
  if (values(last) > 0.0) report.condition = values(0) / values(last);
  return report;
}

std::vector<InterfaceReport> Hierarchical::interfaces(const tree::Walker& walker, int widest) {
  State& s = *state_;
  std::vector<InterfaceReport> reports(at(s.tree.root()));
  auto look = [&](int group) {
    for (const tree::SubdomainId id : s.lanes.groups[at(group)].subdomains)
      if (id != s.tree.root()) reports[at(id)] = s.report_interface(id, widest);
  };
  const SolverCounters counted = s.counters;
  const bool scales_wanted = std::exchange(s.scales_wanted, false);
  (void)s.factor_all(walker, {}, nullptr, make_visit_work(look));
  s.scales_wanted = scales_wanted;
  s.counters = counted;
  return reports;
}

}  // namespace bough::solve
