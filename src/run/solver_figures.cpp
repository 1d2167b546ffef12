#include "solver_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bough/schedule/serial.hpp"

namespace bough::run {

namespace {

constexpr int widest_for_condition = 60;  // the dense SVD of wider interfaces would take longer than short runs

/// Upper bound of the largest row sum of |D_r A D_c|: absolute values are summed over elements.
double norm_of(step::System& system, const solve::Hierarchical& solver) {
  const blocks::BlockGraph& g = system.plan().graph;
  const std::span<const double> rows = solver.row_scale(), columns = solver.column_scale();
  std::vector<double> sums(static_cast<std::size_t>(system.linear().tree().num_unknowns()), 0.0);
  std::vector<std::size_t> unknowns;
  for (int e = 0; e < g.num_elements(); ++e) {
    unknowns.clear();
    for (std::int64_t k = g.element_begin[static_cast<std::size_t>(e)];
         k < g.element_begin[static_cast<std::size_t>(e) + 1]; ++k) {
      const int block = g.element_blocks[static_cast<std::size_t>(k)];
      for (int i = 0; i < g.block_size[static_cast<std::size_t>(block)]; ++i)
        unknowns.push_back(static_cast<std::size_t>(system.places().block_begin(block) + i));
    }
    const solve::ConstElementView a = solver.element(e);
    for (std::size_t i = 0, at = 0; i < unknowns.size(); ++i)
      for (std::size_t j = 0; j < unknowns.size(); ++j, ++at)
        sums[unknowns[i]] += std::abs(a[static_cast<std::int64_t>(at)]) * columns[unknowns[j]];
  }
  double norm = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) norm = std::max(norm, sums[i] * rows[i]);
  return norm;
}

/// A fixed pseudo-random vector of signs, which has a component in every direction.
std::vector<double> signs(std::size_t count) {
  std::vector<double> values(count);
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (double& v : values) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    v = (state >> 63) != 0 ? 1.0 : -1.0;
  }
  return values;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

int widest_interface(const tree::Tree& tree) {
  int widest = 0;
  for (const tree::Subdomain& s : tree.subdomains)
    widest = std::max(widest, tree.fronts[static_cast<std::size_t>(s.top())].num_boundary);
  return widest;
}

bool has_narrow_interfaces(const tree::Tree& tree) {
  return widest_interface(tree) <= widest_for_condition && tree.num_subdomains() <= 10000;
}

/// Levels of the tree with their widths, and the condition numbers of their interfaces if these are narrow.
/// indefinite: receives the number of those whose stiffness is not definite, which no bound on the condition holds for.
std::vector<records::LevelFigures> make_levels(step::System& system, int& indefinite) {
  const tree::Tree& tree = system.linear().tree();
  std::vector<records::LevelFigures> levels;
  for (const tree::Subdomain& s : tree.subdomains) {
    levels.resize(std::max(levels.size(), static_cast<std::size_t>(s.level) + 1));
    records::LevelFigures& level = levels[static_cast<std::size_t>(s.level)];
    ++level.subdomains;
    level.interface_unknowns =
        std::max(level.interface_unknowns, tree.fronts[static_cast<std::size_t>(s.top())].num_boundary);
  }
  for (std::size_t l = 0; l < levels.size(); ++l) levels[l].level = static_cast<int>(l);
  if (!has_narrow_interfaces(tree)) return levels;
  // The walker of the run may be timed, and this factorization is not one of its steps.
  for (const solve::InterfaceReport& i :
       system.linear().solver().interfaces(schedule::make_serial_walker(), widest_for_condition)) {
    records::LevelFigures& level = levels[static_cast<std::size_t>(i.level)];
    level.condition = std::max(level.condition, i.condition);
    indefinite += i.is_definite ? 0 : 1;
  }
  return levels;
}

/// Estimates the condition number by inverse iteration from a vector of signs, which approximates the largest growth
/// within a small factor after few iterations. Returns 0 if unknown. first: called with the first right-hand side, its
/// solution, and |A|.
template <class First>
double estimate_condition(step::System& system, const solve::Hierarchical& solver, First&& first) {
  constexpr int iterations = 4;
  const std::span<const double> rows = solver.row_scale(), columns = solver.column_scale();
  const auto n = static_cast<std::size_t>(system.linear().tree().num_unknowns());
  std::vector<double> scaled = signs(n), b(n), x(n);
  const double norm = norm_of(system, solver);
  double growth = 0.0;
  for (int k = 0; k < iterations; ++k) {
    for (std::size_t i = 0; i < n; ++i) b[i] = scaled[i] / rows[i];
    (void)system.linear().solver().solve(system.walker(), b.data(), x.data());
    if (k == 0) first(b, x, norm);
    for (std::size_t i = 0; i < n; ++i) scaled[i] = x[i] / columns[i];
    const double most = largest(scaled);
    if (!(most > 0.0) || !std::isfinite(most)) return 0.0;
    growth = std::max(growth, most);
    for (double& v : scaled) v /= most;
  }
  return norm * growth;
}

/// Backward errors of a solution by the level of the tree at which unknowns are eliminated.
void add_backward_errors(step::System& system, const solve::Hierarchical& solver, const std::vector<double>& b,
                         const std::vector<double>& x, double norm, std::vector<records::LevelFigures>& levels) {
  // With dependent rows the system may be inconsistent, and backward errors have no meaning.
  if (solver.last_status().deficiency != 0) return;
  const tree::Tree& tree = system.linear().tree();
  const std::span<const double> rows = solver.row_scale(), columns = solver.column_scale();
  std::vector<double> product(x.size()), solution(x.size());
  system.linear().solver().multiply(system.walker(), x.data(), product.data());
  for (std::size_t i = 0; i < x.size(); ++i) solution[i] = x[i] / columns[i];
  const double size = norm * largest(solution) + 1.0;
  for (int block = 0; block < system.plan().graph.num_blocks(); ++block) {
    const tree::Front& front =
        tree.fronts[static_cast<std::size_t>(tree.front_of_block[static_cast<std::size_t>(block)])];
    records::LevelFigures& level =
        levels[static_cast<std::size_t>(tree.subdomains[static_cast<std::size_t>(front.subdomain)].level)];
    for (auto i = static_cast<std::size_t>(system.places().block_begin(block));
         i < static_cast<std::size_t>(system.places().block_begin(block + 1)); ++i)
      level.backward_error = std::max(level.backward_error, std::abs(b[i] - product[i]) * rows[i] / size);
  }
}

}  // namespace

void look_at_last_factor(step::System& system, records::Summary& summary) {
  const solve::AnySolver& any = system.linear().solver();
  const solve::Hierarchical* solver = any.hierarchical();
  if (solver == nullptr && any.augmented() == nullptr) return;
  if (system.counts().factorizations == 0 || !any.last_status().ok()) return;
  int indefinite = 0;
  summary.levels = make_levels(system, indefinite);
  if (has_narrow_interfaces(system.linear().tree())) {
    double most = 1.0;
    for (const records::LevelFigures& level : summary.levels) most = std::max(most, level.condition);
    summary.solver.emplace_back("interface_condition_max", most);
    summary.solver.emplace_back("interfaces_indefinite", indefinite);
  }
  if (solver == nullptr) return;
  const double condition =
      estimate_condition(system, *solver, [&](const std::vector<double>& b, const std::vector<double>& x, double norm) {
        add_backward_errors(system, *solver, b, x, norm, summary.levels);
      });
  if (condition == 0.0) return;
  summary.solver.emplace_back("condition_estimate", condition);
  summary.solver.emplace_back("digits_lost", std::max(0.0, std::log10(condition)));
}

decltype(records::Summary::solver) solver_figures(step::System& system, int dependent_rows) {
  const tree::Tree& tree = system.linear().tree();
  int levels = 0, leaves = 0;
  for (const tree::Subdomain& s : tree.subdomains) {
    levels = std::max(levels, s.level + 1);
    leaves += s.is_leaf() ? 1 : 0;
  }
  const solve::SolverCounters counters = system.linear().solver().counters();
  decltype(records::Summary::solver) figures = {
      {"unknowns", static_cast<double>(tree.num_unknowns())},
      {"sub_domains", static_cast<double>(tree.num_subdomains())},
      {"leaves", static_cast<double>(leaves)},
      {"levels", static_cast<double>(levels)},
      {"factor_bytes", static_cast<double>(counters.memory_bytes)},
      {"flops_per_factorization", counters.factor_flops},
      {"delayed_pivots", static_cast<double>(system.linear().delayed_pivots())},
      {"dependent_rows", static_cast<double>(dependent_rows)}};
  if (const solve::Dual* dual = system.linear().solver().dual();
      dual != nullptr && system.counts().factorizations > 0) {
    const solve::InterfaceReport i = dual->interfaces().front();
    figures.emplace_back("interface_unknowns", i.num_unknowns);
    figures.emplace_back("interface_coarse_unknowns", i.num_coarse);
    figures.emplace_back("interface_floating_directions", i.num_floating);
    if (std::isfinite(i.condition)) figures.emplace_back("interface_condition", i.condition);
    figures.emplace_back("interface_flops", i.flops);
    figures.emplace_back("interface_seconds", i.seconds);
    figures.emplace_back("interface_iterations", i.iterations);
  }
  const solve::AnySolver& any = system.linear().solver();
  if ((any.hierarchical() != nullptr || any.augmented() != nullptr) && system.counts().factorizations > 0)
    figures.emplace_back("interface_unknowns_max", static_cast<double>(widest_interface(tree)));
  return figures;
}

}  // namespace bough::run
