/// Quantities of the method: interface flexibility, its condition, local multipliers, and the textbook condensation
/// through it.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "decompositions.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
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

namespace {

/// All sub-domains one after the other.
tree::Walker serial_walker() {
  return {[](void*, const tree::Tree& tree, tree::Visit visit) {
            for (tree::SubdomainId s = 0; s < tree.num_subdomains(); ++s) visit.run(visit.context, s);
          },
          [](void*, const tree::Tree& tree, tree::Visit visit) {
            for (tree::SubdomainId s = tree.num_subdomains(); s-- > 0;) visit.run(visit.context, s);
          },
          [](void*, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
            for (std::int64_t i = 0; i < count; i += grain) chunk.run(chunk.context, i, std::min(i + grain, count));
          },
          nullptr};
}

}  // namespace

/// Only factors are kept, not the Schur complements that reports need. These come from a factorization of the same
/// matrices and scales that stores all of them (symmetric ones as one triangle), without lanes, made at the first
/// report.
const Hierarchical& Hierarchical::reporting_solver() const {
  State& s = *state_;
  const std::lock_guard lock(s.reporting);
  if ((s.keeps_all && s.lanes.fronts.empty() && !s.is_symmetric()) || s.counters.factorizations == 0) return *this;
  if (s.twin == nullptr) {
    SolveOptions options = s.options;
    options.lanes = false;
    options.symmetry = Symmetry::general;
    s.twin = std::make_unique<Hierarchical>(s.elements.graph(), s.tree, options);
    s.twin->state_ = std::make_unique<State>(s.elements.graph(), s.tree, options, true);
  }
  State& twin = *s.twin->state_;
  if (s.twin_factorization != s.counters.factorizations) {
    for (int e = 0; e < s.elements.graph().num_elements(); ++e) {
      const int n = s.elements.size_of(e);
      for (int k = 0; k < n * n; ++k) twin.elements.view(e)[k] = s.elements.view(e)[k];
    }
    twin.scales = s.scales;
    twin.scales_wanted = false;
    (void)s.twin->factor(serial_walker());
    s.twin_factorization = s.counters.factorizations;
  }
  return *s.twin;
}

std::vector<InterfaceReport> Hierarchical::interfaces(int widest) const {
  const State& state = *reporting_solver().state_;
  std::vector<InterfaceReport> reports;
  for (tree::SubdomainId s = 0; s < state.tree.root(); ++s) {
    const tree::Subdomain& sub = state.tree.subdomains[at(s)];
    const FrontData& d = state.data(sub.top());
    const int n = d.size - d.full;
    InterfaceReport report{.subdomain = s, .level = sub.level, .num_unknowns = n, .num_delayed = d.num_delayed()};
    report.flops = sub.flops;
    if (n > widest) {
      report.condition = std::numeric_limits<double>::quiet_NaN();
      reports.push_back(report);
      continue;
    }
    if (n > 0 && !d.failed && state.counters.factorizations > 0) {
      std::vector<double> stiffness = state.interface_stiffness(s);
      Matrix stiffened = ConstMap(d.s, n, n, Eigen::OuterStride<>(d.lds));
      std::vector<int> motion;
      for (int i = 0; i < n; ++i) {
        const double penalty = state.options.penalty_factor * stiffness[at(i)];
        stiffened(i, i) += penalty;
        if (penalty <= 0.0) continue;
        report.penalty_least = motion.empty() ? penalty : std::min(report.penalty_least, penalty);
        report.penalty_most = std::max(report.penalty_most, penalty);
        motion.push_back(i);
      }
      const std::optional<Matrix> flexibility = solve_if_regular(stiffened, Matrix::Identity(n, n));
      if (!flexibility) {  // rows that are empty here belong to unknowns that are held further up
        reports.push_back(report);
        continue;
      }
      const Matrix& F = *flexibility;
      Matrix scaled(motion.size(), motion.size());
      for (std::size_t i = 0; i < motion.size(); ++i)
        for (std::size_t j = 0; j < motion.size(); ++j)
          scaled(static_cast<int>(i), static_cast<int>(j)) =
              F(motion[i], motion[j]) * state.options.penalty_factor *
              std::sqrt(stiffness[at(motion[i])] * stiffness[at(motion[j])]);
      if (!motion.empty() && scaled.allFinite()) {
        const Eigen::VectorXd values = singular_values(scaled);
        Eigen::Index last =
            values.size() - 1;  // directions that joints hold at the interface itself have no flexibility
        while (last > 0 && values(last) <= 1e-13 * values(0)) --last;
        if (values(last) > 0.0) report.condition = values(0) / values(last);
      }
    }
    reports.push_back(report);
  }
  return reports;
}

}  // namespace bough::solve
