/// bench_penalties [CASE]
/// Accuracy lost by a penalty: the error of one solution against extended precision, for each form of the solver, over
/// the penalty factor; and the worst condition of the scaled interface flexibility in the tree. There is no refinement.
/// The right-hand side belongs to a random solution of order one in scaled unknowns. Prints Markdown tables.
#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "../support/scenes.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/run/simulate.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/solve/dual.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/step/advance.hpp"

namespace {

using namespace bough;
using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using ExtendedVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

struct Case {
  std::string name, what;
  int leaf_size;
  scene::Scene scene;
};

class NoRecorder final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

/// Element matrices of the first Newton iteration of the first step.
struct Matrices {
  blocks::BlockGraph graph;
  std::vector<std::vector<double>> elements;
};

Matrices make_matrices(const scene::Scene& scene) {
  Matrices m;
  run::SimulateOptions options;
  options.before_step = [&](step::System& system, const step::State& start, const run::BeforeStep& attempt) {
    step::State state = start;
    elements::Slopes slopes;
    std::optional<step::Trouble> trouble;
    if (system.plan().is_dynamic)
      trouble = step::predict(system, state, attempt.options, attempt.end, slopes);
    else
      trouble = system.set_time(attempt.end);
    if (!trouble) trouble = system.evaluate(state, slopes, true);
    if (trouble) return false;
    m.graph = system.plan().graph;
    for (int e = 0; e < m.graph.num_elements(); ++e) {
      std::int64_t n = 0;
      for (auto k = m.graph.element_begin[at(e)]; k < m.graph.element_begin[at(e) + 1]; ++k)
        n += m.graph.block_size[at(m.graph.element_blocks[at(k)])];
      const solve::ElementView a = system.linear().solver().element(e);
      std::vector<double> values;
      for (std::int64_t k = 0; k < n * n; ++k) values.push_back(a[k]);
      m.elements.push_back(std::move(values));
    }
    return false;
  };
  NoRecorder nobody;
  (void)run::simulate(scene, options, nobody);
  return m;
}

template <class Solver>
void write_elements(const Matrices& m, Solver& solver) {
  for (std::size_t e = 0; e < m.elements.size(); ++e) {
    const solve::ElementView view = solver.element(static_cast<int>(e));
    for (std::size_t k = 0; k < m.elements[e].size(); ++k) view[static_cast<std::int64_t>(k)] = m.elements[e][k];
  }
}

/// The scaled problem D_r A D_c y = D_r b with its solution in extended precision.
struct Reference {
  Eigen::VectorXd column_scale, rhs;  ///< rhs: of the unscaled problem
  Eigen::MatrixXd scaled;
  ExtendedVector solution;   ///< scaled
  std::vector<bool> counts;  ///< unknowns that are unique
  bool only_motion = false;
  double condition = 0.0;
};

Reference make_reference(const Matrices& m, const tree::Tree& tree) {
  Reference r;
  solve::Hierarchical solver(m.graph, tree);
  write_elements(m, solver);
  const solve::FactorStatus status = solver.factor(schedule::make_serial_walker());
  const auto n = static_cast<Eigen::Index>(tree.num_unknowns());
  r.column_scale = Eigen::Map<const Eigen::VectorXd>(solver.column_scale().data(), n);
  const Eigen::VectorXd row_scale = Eigen::Map<const Eigen::VectorXd>(solver.row_scale().data(), n);
  Extended a = Extended::Zero(n, n);
  for (std::size_t e = 0; e < m.elements.size(); ++e) {
    std::vector<Eigen::Index> place;
    for (auto k = m.graph.element_begin[e]; k < m.graph.element_begin[e + 1]; ++k) {
      const int b = m.graph.element_blocks[at(k)];
      for (int i = 0; i < m.graph.block_size[at(b)]; ++i) place.push_back(tree.unknown_begin[at(b)] + i);
    }
    for (std::size_t i = 0; i < place.size(); ++i)
      for (std::size_t j = 0; j < place.size(); ++j)
        a(place[i], place[j]) += static_cast<long double>(m.elements[e][i * place.size() + j]) *
                                 static_cast<long double>(row_scale(place[i]) * r.column_scale(place[j]));
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ExtendedVector wanted(n);
  for (Eigen::Index i = 0; i < n; ++i) wanted(i) = static_cast<long double>(uniform(random));
  const ExtendedVector scaled_rhs = a * wanted;
  r.rhs.resize(n);
  ExtendedVector rounded(n);  // the right-hand side for all solvers
  for (Eigen::Index i = 0; i < n; ++i) {
    r.rhs(i) = static_cast<double>(scaled_rhs(i) / static_cast<long double>(row_scale(i)));
    rounded(i) = static_cast<long double>(r.rhs(i)) * static_cast<long double>(row_scale(i));
  }
  r.only_motion = status.deficiency > 0;
  if (r.only_motion) {
    Eigen::FullPivLU<Extended> lu(a);
    lu.setThreshold(1e-14L);
    r.solution = lu.solve(rounded);
  } else {
    r.solution = Eigen::PartialPivLU<Extended>(a).solve(rounded);
  }
  r.scaled = a.cast<double>();
  for (int b = 0; b < m.graph.num_blocks(); ++b)
    r.counts.insert(r.counts.end(), at(m.graph.block_size[at(b)]),
                    !r.only_motion || m.graph.block_kind[at(b)] == blocks::BlockKind::motion);
  const Eigen::VectorXd values = Eigen::BDCSVD<Eigen::MatrixXd>(r.scaled).singularValues();
  r.condition = values(0) / values(n - 1 - status.deficiency);
  return r;
}

/// max |y - reference| / max |reference| over the unknowns that are unique.
double error_of(const Reference& r, const Eigen::VectorXd& scaled_solution) {
  long double difference = 0.0L, size = 0.0L;
  for (Eigen::Index i = 0; i < scaled_solution.size(); ++i) {
    if (!r.counts[at(i)]) continue;
    const long double d = std::abs(static_cast<long double>(scaled_solution(i)) - r.solution(i));
    if (!(d <= difference)) difference = d;
    size = std::max(size, std::abs(r.solution(i)));
  }
  return static_cast<double>(difference / size);
}

template <class Solver>
double solve_with(Solver&& solver, const Matrices& m, const Reference& r) {
  write_elements(m, solver);
  const tree::Walker walker = schedule::make_serial_walker();
  if (!solver.factor(walker).ok()) return std::nan("");
  Eigen::VectorXd x(r.rhs.size());
  (void)solver.solve(walker, r.rhs.data(), x.data());
  return error_of(r, x.cwiseQuotient(r.column_scale));
}

std::string text(double x) {
  if (std::isnan(x)) return "fails";
  char out[32];
  std::snprintf(out, sizeof out, "%.1e", x);
  return out;
}

void print_case(const Case& c) {
  const Matrices m = make_matrices(c.scene);
  if (m.elements.empty()) {
    std::printf("%s: the first step cannot be evaluated\n", c.name.c_str());
    return;
  }
  const tree::Tree tree = tree::make_tree(m.graph, {.leaf_size = c.leaf_size});
  const Reference r = make_reference(m, tree);
  int levels = 0;
  for (const tree::Subdomain& s : tree.subdomains) levels = std::max(levels, s.level + 1);
  double whole = std::nan("");
  if (!r.only_motion) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(r.scaled);
    // Scales are powers of two, so the scaled right-hand side is exact.
    Eigen::VectorXd b(r.rhs.size());
    solve::Hierarchical scales(m.graph, tree);
    write_elements(m, scales);
    (void)scales.factor(schedule::make_serial_walker());
    b = r.rhs.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(scales.row_scale().data(), r.rhs.size()));
    whole = error_of(r, lu.solve(b));
  }
  std::printf("\n%s: %s; %lld unknowns, %d sub-domains on %d levels, condition %s%s\n\n", c.name.c_str(),
              c.what.c_str(), static_cast<long long>(tree.num_unknowns()), tree.num_subdomains(), levels,
              text(r.condition).c_str(), r.only_motion ? "; dependent rows: errors of the motion alone" : "");
  std::printf(
      "| penalty factor | local | local, plain | global | hybrid | condition of the interfaces "
      "|\n|---|---|---|---|---|---|\n");
  if (!r.only_motion) std::printf("| one LU of the whole | %s | | | | |\n", text(whole).c_str());
  for (double factor = 1e-6; factor < 2e12; factor *= 1e3) {
    solve::SolveOptions options{.penalty_factor = factor, .refinement_steps = 0};
    solve::Hierarchical local(m.graph, tree, options);
    const double local_error = solve_with(local, m, r);
    double condition = 1.0;
    for (const solve::InterfaceReport& i : local.interfaces()) condition = std::max(condition, i.condition);
    const double global = solve_with(solve::Dual(m.graph, tree, {.form = solve::DualForm::global}, options), m, r);
    const double hybrid = solve_with(solve::Dual(m.graph, tree, {.form = solve::DualForm::hybrid}, options), m, r);
    options.elimination = solve::Elimination::plain;
    const double plain = solve_with(solve::Hierarchical(m.graph, tree, options), m, r);
    std::printf("| %.0e | %s | %s | %s | %s | %s |\n", factor, text(local_error).c_str(), text(plain).c_str(),
                text(global).c_str(), text(hybrid).c_str(), text(condition).c_str());
    std::fflush(stdout);
  }
}

/// One straight bar of 64 elements, clamped.
scene::Scene make_cantilever() {
  scene::Scene s = bench::make_chain(1);
  s.beams.front().elements = 64;
  s.joints.front().kind = scene::JointKind::fixed;
  s.analysis.kind = scene::AnalysisKind::statics;
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Case> cases{{"cantilever", "statics, one bar of 64 elements", 16, make_cantilever()},
                          {"chain", "dynamics, step 1e-3 s, 32 links of 4 elements", 16, bench::make_chain(32)},
                          {"lattice", "dynamics, step 1e-3 s, 12 x 12 nodes, clamped", 24,
                           bench::make_lattice_2d(12, bench::Support::clamp)}};
  const io::SceneFile four_bar = io::read_scene(std::string(BOUGH_SCENARIOS) + "/four_bar_planar.json");
  if (!four_bar.ok()) {
    std::fprintf(stderr, "bench_penalties: %s\n", four_bar.problems.front().text().c_str());
    return 2;
  }
  cases.push_back({"four_bar", "dynamics, as four_bar_planar.json", 4, four_bar.scene});
  for (const Case& c : cases)
    if (argc < 2 || c.name == argv[1]) print_case(c);
  return 0;
}
