/// Reports of interfaces: their flexibilities and the conditions of these.
#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <utility>

#include "bough/blocks/at.hpp"
#include "flexibility.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

using Matrix = Eigen::MatrixXd;
using ConstMap = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;
using Map = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

}  // namespace

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
InterfaceReport Hierarchical::State::report_interface(tree::SubdomainId s, int widest, bool keeps_matrices) {
  const tree::Subdomain& sub = tree.subdomains[at(s)];
  const tree::FrontId top = sub.top();
  const int n = front(top).num_boundary;
  InterfaceReport report{.subdomain = s, .level = sub.level, .num_unknowns = n};
  report.flops = sub.flops;
  if (is_scalar(top)) report.num_delayed = data(top).num_delayed();
  if (n > widest) report.condition = std::numeric_limits<double>::quiet_NaN();
  if (n == 0 || n > widest || (is_scalar(top) && data(top).failed)) return report;
  Matrix S(n, n);
  copy_schur(top, S.data());
  std::vector<Eigen::Index> tied;  // multipliers belong to the interface mesh
  Eigen::Index row = 0;
  for_boundary(top, [&](int, std::size_t u) {
    if (!is_constraint[u]) {
      tied.push_back(row);
      if (keeps_matrices) report.matrices.unknowns.push_back(static_cast<std::int64_t>(u));
    }
    ++row;
  });
  if (tied.empty()) return report;
  const StiffenedInterface stiffened = stiffen(S(tied, tied), options.penalty_factor);
  report_flexibility(S(tied, tied), stiffened.penalty, stiffened.factor.inverse(), keeps_matrices, report);
  return report;
}

std::vector<InterfaceReport> Hierarchical::interfaces(const tree::Walker& walker, int widest, bool keeps_matrices) {
  State& s = *state_;
  std::vector<InterfaceReport> reports(at(s.tree.root()));
  auto look = [&](int group) {
    for (const tree::SubdomainId id : s.lanes.groups[at(group)].subdomains)
      if (id != s.tree.root()) reports[at(id)] = s.report_interface(id, widest, keeps_matrices);
  };
  const SolverCounters counted = s.counters;
  const bool scales_wanted = std::exchange(s.scales_wanted, false);
  (void)s.factor_all(walker, {}, nullptr, make_visit_work(look));
  s.scales_wanted = scales_wanted;
  s.counters = counted;
  return reports;
}

}  // namespace bough::solve
