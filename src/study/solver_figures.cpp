#include "solver_figures.hpp"

#include <algorithm>
#include <cmath>

namespace bough::study {

decltype(results::Summary::solver) solver_figures(step::System& system, int dependent_rows) {
  const tree::Tree& tree = system.tree();
  int levels = 0, leaves = 0;
  for (const tree::Subdomain& s : tree.subdomains) {
    levels = std::max(levels, s.level + 1);
    leaves += s.is_leaf() ? 1 : 0;
  }
  const solve::SolverCounters counters = system.solver().counters();
  decltype(results::Summary::solver) figures = {{"unknowns", static_cast<double>(tree.num_unknowns())},
                                                {"sub_domains", static_cast<double>(tree.num_subdomains())},
                                                {"leaves", static_cast<double>(leaves)},
                                                {"levels", static_cast<double>(levels)},
                                                {"factor_bytes", static_cast<double>(counters.memory_bytes)},
                                                {"flops_per_factorization", counters.factor_flops},
                                                {"delayed_pivots", static_cast<double>(counters.delayed_pivots)},
                                                {"dependent_rows", static_cast<double>(dependent_rows)}};
  if (const solve::Dual* dual = system.solver().dual(); dual != nullptr && system.counts().factorizations > 0) {
    const solve::InterfaceReport i = dual->interfaces().front();
    figures.emplace_back("interface_unknowns", i.num_unknowns);
    figures.emplace_back("interface_coarse_unknowns", i.num_coarse);
    figures.emplace_back("interface_floating_directions", i.num_floating);
    if (std::isfinite(i.condition)) figures.emplace_back("interface_condition", i.condition);
    figures.emplace_back("interface_flops", i.flops);
    figures.emplace_back("interface_seconds", i.seconds);
    figures.emplace_back("interface_iterations", i.iterations);
  }
  const solve::Hierarchical* hierarchical = system.solver().hierarchical();
  if (hierarchical == nullptr || system.counts().factorizations == 0) return figures;
  constexpr int widest_for_condition = 60;  // dense singular values of wider ones would take longer than short runs
  int widest = 0;
  for (const tree::Subdomain& s : tree.subdomains)
    widest = std::max(widest, tree.fronts[static_cast<std::size_t>(s.top())].num_boundary);
  figures.emplace_back("interface_unknowns_max", static_cast<double>(widest));
  if (widest <= widest_for_condition && tree.num_subdomains() <= 10000) {
    double condition = 1.0;
    for (const solve::InterfaceReport& i : hierarchical->interfaces()) condition = std::max(condition, i.condition);
    figures.emplace_back("interface_condition_max", condition);
  }
  return figures;
}

}  // namespace bough::study
