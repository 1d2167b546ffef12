#include "profile_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "profile_schedule.hpp"

namespace bough::study {

namespace {

constexpr std::size_t num_features = 3;
using Features = std::array<double, num_features>;

Features features_of(const solve::VisitShape& v) {
  return {static_cast<double>(v.num_fronts), v.flops, static_cast<double>(v.factor_bytes + v.element_bytes)};
}

/// Solves the normal equations for the features in `set` alone; false where they are dependent or a coefficient would
/// be negative.
bool fit_set(const std::vector<Features>& rows, const std::vector<double>& seconds, unsigned set, Features& result) {
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < num_features; ++k)
    if ((set >> k & 1u) != 0) used.push_back(k);
  const std::size_t n = used.size();
  Features scale{};
  for (std::size_t k : used)
    for (std::size_t r = 0; r < rows.size(); ++r) scale[k] = std::max(scale[k], rows[r][k] / seconds[r]);
  std::array<std::array<double, num_features + 1>, num_features> a{};
  for (std::size_t k : used)
    if (scale[k] == 0.0) return false;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < n; ++i) {
      const double x = rows[r][used[i]] / (seconds[r] * scale[used[i]]);
      for (std::size_t j = 0; j < n; ++j) a[i][j] += x * rows[r][used[j]] / (seconds[r] * scale[used[j]]);
      a[i][n] += x;
    }
  for (std::size_t k = 0; k < n; ++k) {  // positive definite: no interchanges
    const double diagonal = a[k][k];
    double original = 0.0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double x = rows[r][used[k]] / (seconds[r] * scale[used[k]]);
      original += x * x;
    }
    if (!(diagonal > 1e-10 * original)) return false;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double l = a[i][k] / diagonal;
      for (std::size_t j = k; j <= n; ++j) a[i][j] -= l * a[k][j];
    }
  }
  result = {};
  for (std::size_t k = n; k-- > 0;) {
    double x = a[k][n];
    for (std::size_t j = k + 1; j < n; ++j) x -= a[k][j] * result[used[j]];
    result[used[k]] = x / a[k][k];
    if (result[used[k]] < 0.0) return false;
  }
  for (std::size_t k : used) result[k] /= scale[k];
  return true;
}

double seconds_of(const Features& f, const Features& costs) {
  return f[0] * costs[0] + f[1] * costs[1] + f[2] * costs[2];
}

records::CostFit fit_kind(std::span<const solve::VisitShape> visits, const std::vector<double>& seconds,
                          bool in_lanes) {
  records::CostFit fit{.in_lanes = in_lanes};
  std::vector<Features> rows;
  std::vector<double> times;
  for (std::size_t v = 0; v < visits.size(); ++v) {
    if (visits[v].in_lanes != in_lanes || !(seconds[v] > 0.0)) continue;
    rows.push_back(features_of(visits[v]));
    times.push_back(seconds[v]);
  }
  fit.num_visits = static_cast<int>(rows.size());
  if (rows.empty()) return fit;
  double least = std::numeric_limits<double>::infinity();
  Features best{};
  for (unsigned set = 1; set < 1u << num_features; ++set) {
    Features costs;
    if (!fit_set(rows, times, set, costs)) continue;
    double sum = 0.0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double error = seconds_of(rows[r], costs) / times[r] - 1.0;
      sum += error * error;
    }
    if (sum < least) {
      least = sum;
      best = costs;
    }
  }
  fit.per_front = best[0];
  fit.per_flop = best[1];
  fit.per_byte = best[2];
  std::vector<double> errors;
  for (std::size_t r = 0; r < rows.size(); ++r) errors.push_back(std::abs(seconds_of(rows[r], best) / times[r] - 1.0));
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  fit.median_error = errors[errors.size() / 2];
  return fit;
}

records::Alternative describe(const tree::Tree& tree, int leaf_size, int depth) {
  records::Alternative a{.leaf_size = leaf_size, .depth = depth, .num_subdomains = tree.num_subdomains()};
  for (const tree::Subdomain& s : tree.subdomains) {
    a.num_leaves += s.is_leaf() ? 1 : 0;
    a.num_levels = std::max(a.num_levels, s.level + 1);
    a.flops += s.flops;
  }
  return a;
}

bool is_same(const records::Alternative& a, const records::Alternative& b) {
  return a.num_subdomains == b.num_subdomains && a.num_leaves == b.num_leaves && a.num_levels == b.num_levels &&
         a.flops == b.flops;
}

}  // namespace

std::vector<records::CostFit> fit_costs(std::span<const solve::VisitShape> visits, const std::vector<double>& seconds) {
  std::vector<records::CostFit> fits{fit_kind(visits, seconds, false), fit_kind(visits, seconds, true)};
  for (std::size_t k = 0; k < 2; ++k) {
    if (fits[k].num_visits > 0) continue;
    const records::CostFit& other = fits[1 - k];
    fits[k].per_front = other.per_front;
    fits[k].per_flop = other.per_flop;
    fits[k].per_byte = other.per_byte;
  }
  return fits;
}

std::vector<double> predict(std::span<const solve::VisitShape> visits, const std::vector<records::CostFit>& costs) {
  std::vector<double> seconds;
  for (const solve::VisitShape& v : visits) {
    const records::CostFit& c = costs[v.in_lanes ? 1 : 0];
    seconds.push_back(seconds_of(features_of(v), {c.per_front, c.per_flop, c.per_byte}));
  }
  return seconds;
}

std::vector<records::Alternative> try_alternatives(const blocks::BlockGraph& graph, const tree::Tree& present,
                                                   const scene::Solver& solver, int threads, double grain_flops,
                                                   const std::vector<records::CostFit>& costs,
                                                   const solve::SolveOptions& options) {
  const auto price = [&](const tree::Tree& tree, records::Alternative& a) {
    const solve::VisitShapes shapes = solve::make_visit_shapes(graph, tree, options);
    const std::vector<double> seconds = predict(shapes.visits, costs);
    for (double s : seconds) a.predicted += s;
    std::vector<int> counts;
    for (int p = 1; p <= threads; p *= 2) counts.push_back(p);
    if (counts.back() != threads) counts.push_back(threads);
    a.predicted_threads = eval_walks(shapes.walk, seconds, Direction::up, counts, grain_flops).back();
  };
  std::vector<records::Alternative> list{describe(present, solver.leaf_size, solver.depth)};
  list.front().is_present = true;
  price(present, list.front());
  int largest_leaf = 1;
  for (const tree::Subdomain& s : present.subdomains)
    if (s.is_leaf()) largest_leaf = std::max(largest_leaf, s.element_end - s.element_begin);
  std::vector<std::pair<int, int>> wanted{{0, -1}};
  for (int factor : {8, 4, 2}) wanted.emplace_back(std::max(1, largest_leaf / factor), -1);
  for (int factor : {2, 4, 8}) wanted.emplace_back(std::min(graph.num_elements(), largest_leaf * factor), -1);
  for (int shift : {-2, -1, 1, 2}) wanted.emplace_back(0, std::max(0, list.front().num_levels - 1 + shift));
  wanted.emplace_back(0, 0);
  for (const auto& [leaf_size, depth] : wanted) {
    const tree::Tree tree =
        tree::make_tree(graph, {.leaf_size = leaf_size, .depth = depth, .in_lockstep = options.lanes});
    records::Alternative a = describe(tree, leaf_size, depth);
    if (std::any_of(list.begin(), list.end(), [&](const auto& other) { return is_same(a, other); })) continue;
    price(tree, a);
    list.push_back(a);
  }
  std::sort(list.begin() + 1, list.end(),
            [](const auto& a, const auto& b) { return a.predicted_threads < b.predicted_threads; });
  return list;
}

}  // namespace bough::study
