#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "bough/step/options.hpp"
#include "bough/step/state.hpp"

namespace bough::bench {

namespace {

/// A linear congruential generator (Knuth's constants), which gives the same numbers on every machine.
class Random {
 public:
  double operator()() {  ///< uniform in [-1, 1)
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1.0;
  }

 private:
  std::uint64_t state_ = 20240517;
};

step::State make_lively_state(const plan::Plan& plan, Random& random) {
  step::State state = step::make_initial_state(plan);
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    motion::Vec6<double> eta, twist, rate;
    for (int i = 0; i < 6; ++i) {
      eta[i] = (i < 3 ? 1e-4 : 1e-3) * random();  // [m], [rad]
      twist[i] = random();                        // [m/s], [rad/s]
      rate[i] = 10.0 * random();
    }
    step::move_node(plan, state, n, eta);
    step::set_velocity(plan, state, n, twist);
    step::set_acceleration(plan, state, n, rate);
  }
  for (double& m : state.multipliers) m = 100.0 * random();
  return state;
}

elements::Field make_field(const plan::Plan& plan, const step::State& state, std::vector<double>& laws) {
  laws.clear();
  for (const plan::LawPlan& l : plan.laws) laws.push_back(l.law.at(0.0, laws::Side::right).value);
  constexpr double h = 1e-3;
  const step::AlphaCoefficients c = step::make_alpha_coefficients(0.8);
  elements::Field f;
  f.nodes = step::nodes_in_space(plan, state).data();
  f.slopes = {c.gamma / (c.beta * h), (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h), false};
  f.around.gravity = plan.gravity;
  f.around.laws = laws.data();
  f.around.has_inertia = true;
  return f;
}

std::vector<std::vector<double>> eval_elements(const plan::Plan& plan, const step::State& state) {
  std::vector<std::vector<double>> matrices(plan.directory.size());
  std::vector<double> laws, residual(64);
  const elements::Field field = make_field(plan, state, laws);
  std::vector<const plan::JointPlan*> joint_of(plan.directory.size(), nullptr);
  for (const plan::JointPlan& j : plan.joints) joint_of[at(j.element)] = &j;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    const double* multipliers =
        joint_of[e] != nullptr ? state.multipliers.data() + joint_of[e]->multiplier_begin : nullptr;
    plan::with_element(plan.elements, plan.directory[e], [&](const auto& element) {
      const std::size_t n = at(elements::num_unknowns(element));
      matrices[e].assign(n * n, 0.0);
      residual.resize(std::max(residual.size(), n));
      elements::evaluate(element, field, multipliers, 0.0, residual.data(), matrices[e].data());
    });
  }
  return matrices;
}

void symmetrise(Problem& p) {
  for (std::vector<double>& a : p.elements) {
    const auto n = at(std::lround(std::sqrt(static_cast<double>(a.size()))));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) a[i * n + j] = a[j * n + i] = 0.5 * (a[i * n + j] + a[j * n + i]);
  }
}

/// Calls f(row, column, value reference) for every entry of every element.
template <class F>
void for_each_entry(Problem& p, F&& f) {
  std::vector<int> place;
  for (std::size_t e = 0; e < p.elements.size(); ++e) {
    place.clear();
    for (std::int64_t k = p.graph.element_begin[e]; k < p.graph.element_begin[e + 1]; ++k) {
      const std::size_t block = at(p.graph.element_blocks[at(k)]);
      for (int i = 0; i < p.graph.block_size[block]; ++i) place.push_back(p.unknown_begin[block] + i);
    }
    const std::size_t n = place.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) f(place[i], place[j], p.elements[e][i * n + j]);
  }
}

double power_of_two(double x) { return std::exp2(std::round(std::log2(x))); }

void equilibrate(Problem& p) {
  const auto n = at(p.unknown_begin.back());
  std::vector<double> diagonal(n, 0.0), scale(n, 1.0), largest(n, 0.0);
  for_each_entry(p, [&](int i, int j, double a) { diagonal[at(i)] += i == j ? a : 0.0; });
  for (std::size_t i = 0; i < n; ++i)
    if (diagonal[i] != 0.0) scale[i] = power_of_two(1.0 / std::sqrt(std::abs(diagonal[i])));
  for_each_entry(p, [&](int i, int j, double a) {
    if (diagonal[at(i)] == 0.0) largest[at(i)] = std::max(largest[at(i)], std::abs(a) * scale[at(j)]);
  });
  for (std::size_t i = 0; i < n; ++i)
    if (diagonal[i] == 0.0) scale[i] = power_of_two(1.0 / largest[i]);
  for_each_entry(p, [&](int i, int j, double& a) { a *= scale[at(i)] * scale[at(j)]; });
}

struct Entry {
  int row;
  double value, mirror;
};

void assemble(Problem& p) {
  const int n = p.unknown_begin.back();
  std::vector<std::vector<Entry>> columns(at(n));
  for_each_entry(p, [&](int i, int j, double a) {
    columns[at(j)].push_back({i, a, 0.0});
    columns[at(i)].push_back({j, 0.0, a});
  });
  p.matrix.n = n;
  p.matrix.column_begin.assign(1, 0);
  for (std::vector<Entry>& list : columns) {
    std::stable_sort(list.begin(), list.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    for (std::size_t k = 0; k < list.size();) {
      Entry sum = list[k];
      for (++k; k < list.size() && list[k].row == sum.row; ++k) {
        sum.value += list[k].value;
        sum.mirror += list[k].mirror;
      }
      if (sum.value == 0.0 && sum.mirror == 0.0) continue;
      p.matrix.row.push_back(sum.row);
      p.matrix.value.push_back(sum.value);
    }
    p.matrix.column_begin.push_back(p.matrix.num_entries());
    list = {};
  }
}

}  // namespace

Problem make_problem(const std::string& name, const scene::Scene& given, Values values) {
  scene::Scene scene = given;
  scene.without = scene::decision_names();  // the matrix with six unknowns per node, as in other programs
  const plan::Plan plan = plan::make_plan(scene);
  Random random;
  return make_problem(name, plan.graph, eval_elements(plan, make_lively_state(plan, random)), values);
}

Problem make_problem(const std::string& name, const blocks::BlockGraph& graph,
                     std::vector<std::vector<double>> elements, Values values) {
  Problem p;
  p.name = name;
  p.values = values;
  p.graph = graph;
  p.is_definite = p.is_symmetric() &&
                  std::count(graph.block_kind.begin(), graph.block_kind.end(), blocks::BlockKind::multiplier) == 0;
  p.unknown_begin.assign(1, 0);
  for (int size : p.graph.block_size) p.unknown_begin.push_back(p.unknown_begin.back() + size);
  p.elements = std::move(elements);
  if (p.is_symmetric()) symmetrise(p);
  equilibrate(p);
  assemble(p);
  Random random;
  for (int i = 0; i < p.matrix.n; ++i) p.rhs.push_back(random());
  return p;
}

double eval_backward_error(const SparseMatrix& a, const std::vector<double>& x, const std::vector<double>& b) {
  std::vector<double> residual;
  return solve::backward_error(a, x.data(), b.data(), residual);
}

}  // namespace bough::bench
