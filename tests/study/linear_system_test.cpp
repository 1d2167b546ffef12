#include "bough/study/linear_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "../step/small_scenes.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/step/advance.hpp"

namespace bough {
namespace {

using io::SparseMatrix;
using study::LinearSystem;

LinearSystem make(const scene::Scene& scene, const study::StepChoice& choice = {}) {
  std::string cause;
  const auto system = study::make_linear_system(scene, choice, 1, cause);
  EXPECT_TRUE(system) << cause;
  return system ? *system : LinearSystem{};
}

scene::Scene make_cantilever() {
  scene::Scene s = test::make_chain(1);
  s.joints.front().kind = scene::JointKind::fixed;
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 4;
  s.gravity = {{0.0, 0.0, -2.0}};
  return s;
}

/// Without loads, which turn with no node and so have an unsymmetric tangent in the nodes' own axes; its tip is lifted.
scene::Scene make_lifted() {
  scene::Scene s = make_cantilever();
  s.gravity = scene::Vec3::zero();
  scene::PrescribedMotion lift;
  lift.name = "lift";
  lift.at.to = "b0";
  lift.displacement[2] = laws::make_constant(0.01);
  s.motions.push_back(lift);
  return s;
}

/// max_i |b - A x|_i / (|A| y + |b|)_i, y: of every unknown the largest of its kind (displacement, rotation,
/// multiplier), so that a row of a motion that does not occur is measured by what it would be.
double row_wise_error(const LinearSystem& s) {
  std::vector<int> kind(s.rhs.size());
  double largest[3] = {0.0, 0.0, 0.0};
  for (const study::UnknownBlock& b : s.blocks)
    for (int i = 0; i < b.count; ++i) {
      const auto j = static_cast<std::size_t>(b.first + i);
      kind[j] = b.components.starts_with("multipliers") ? 2 : i / 3;
      largest[kind[j]] = std::max(largest[kind[j]], std::abs(s.solution[j]));
    }
  std::vector<double> r = s.rhs, scale(s.rhs.size());
  for (std::size_t i = 0; i < r.size(); ++i) scale[i] = std::abs(r[i]);
  const auto add = [&](std::size_t i, std::size_t j, double value) {
    r[i] -= value * s.solution[j];
    scale[i] += std::abs(value) * largest[kind[j]];
  };
  for (std::size_t j = 0; j < r.size(); ++j)
    for (std::size_t k = s.matrix.column_begin[j]; k < s.matrix.column_begin[j + 1]; ++k) {
      const auto i = static_cast<std::size_t>(s.matrix.row[k]);
      add(i, j, s.matrix.value[k]);
      if (s.matrix.is_symmetric && i != j) add(j, i, s.matrix.value[k]);
    }
  double most = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) most = std::max(most, scale[i] > 0.0 ? std::abs(r[i]) / scale[i] : 0.0);
  return most;
}

/// A reader of its own for what the format allows here.
SparseMatrix read_matrix(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  SparseMatrix m;
  m.is_symmetric = line == "%%MatrixMarket matrix coordinate real symmetric";
  EXPECT_TRUE(m.is_symmetric || line == "%%MatrixMarket matrix coordinate real general") << line;
  while (in.peek() == '%') std::getline(in, line);
  int rows = 0, columns = 0;
  std::size_t entries = 0;
  in >> rows >> columns >> entries;
  EXPECT_EQ(rows, columns);
  m.size = rows;
  m.column_begin.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (std::size_t k = 0; k < entries; ++k) {
    int i = 0, j = 0;
    std::string value;
    in >> i >> j >> value;
    m.row.push_back(i - 1);
    m.value.push_back(std::stod(value));
    m.column_begin[static_cast<std::size_t>(j)] = k + 1;
  }
  EXPECT_TRUE(in.good() || in.eof());
  for (std::size_t j = 1; j < m.column_begin.size(); ++j)
    m.column_begin[j] = std::max(m.column_begin[j], m.column_begin[j - 1]);
  return m;
}

TEST(LinearSystem, MatrixTimesTheSolversSolutionIsTheRightHandSide) {
  for (long step : {1L, 7L}) {
    const LinearSystem s = make(test::make_chain(5), {.number = step});
    ASSERT_EQ(s.solution.size(), s.rhs.size());
    EXPECT_EQ(s.step, step);
    EXPECT_LT(row_wise_error(s), 1e-12);
    double size = 0.0;
    for (double x : s.solution) size = std::max(size, std::abs(x));
    EXPECT_GT(size, 0.0);
  }
}

TEST(LinearSystem, SolutionIsTheFirstIncrementOfNewton) {
  const scene::Scene scene = test::make_chain(3);
  const LinearSystem s = make(scene);
  const plan::Plan plan = plan::make_plan(scene);
  step::System system(plan, scene.solver, schedule::make_serial_walker());
  step::State state = step::make_initial_state(plan);
  step::StepOptions options = step::make_step_options(scene.analysis);
  options.single_solution = true;
  ASSERT_FALSE(system.set_time(0.0, laws::Side::right));
  ASSERT_TRUE(step::make_consistent(system, state, true, scene.analysis.step_size).ok);
  ASSERT_TRUE(step::start_alpha(system, state, options, scene.analysis.step_size).ok);
  step::State predicted = state;
  elements::Slopes slopes;
  ASSERT_FALSE(step::predict(system, predicted, options, scene.analysis.step_size, slopes));
  ASSERT_FALSE(system.evaluate(predicted, slopes, false));
  const std::vector<double> rhs = system.right_hand_side();
  ASSERT_TRUE(step::advance(system, state, options, scene.analysis.step_size).converged);
  ASSERT_EQ(system.work().x.size(), s.solution.size());
  for (std::size_t i = 0; i < s.solution.size(); ++i) {
    EXPECT_NEAR(s.rhs[i], rhs[i], 1e-12 * (1.0 + std::abs(s.rhs[i])));
    EXPECT_NEAR(s.solution[i], system.work().x[i], 1e-9 * (1e-6 + std::abs(s.solution[i])));
  }
}

TEST(LinearSystem, TextReadsBackToTheSameNumbers) {
  for (const scene::Scene& scene : {test::make_chain(3), make_lifted()}) {
    const LinearSystem s = make(scene, {.number = 1});
    const SparseMatrix back = read_matrix(io::matrix_market_text(s.matrix, s.comments("scene")));
    EXPECT_EQ(back.is_symmetric, s.matrix.is_symmetric);
    EXPECT_EQ(back.column_begin, s.matrix.column_begin);
    EXPECT_EQ(back.row, s.matrix.row);
    EXPECT_EQ(back.value, s.matrix.value);
  }
}

TEST(LinearSystem, SymmetricWhereTheTangentIs) {
  const LinearSystem still = make(make_lifted());
  EXPECT_TRUE(still.matrix.is_symmetric);
  EXPECT_LT(row_wise_error(still), 1e-12);
  const auto tip =
      std::find_if(still.blocks.begin(), still.blocks.end(), [](const auto& b) { return b.owner == "'b0'"; });
  ASSERT_NE(tip, still.blocks.end());
  EXPECT_NEAR(std::abs(still.solution[static_cast<std::size_t>(tip->first)]), 0.01,
              1e-15);                                                           // the clamped end has no unknowns
  EXPECT_FALSE(make(test::make_chain(3), {.number = 20}).matrix.is_symmetric);  // it moves
}

TEST(LinearSystem, StepsAreChosenByNumberOrTime) {
  const scene::Scene scene = test::make_chain(2);
  const LinearSystem by_time = make(scene, {.time = 0.0095});
  EXPECT_EQ(by_time.step, 10);
  EXPECT_NEAR(by_time.begin, 0.009, 1e-15);
  EXPECT_NEAR(by_time.end, 0.010, 1e-15);
  EXPECT_EQ(by_time.matrix.value, make(scene, {.number = 10}).matrix.value);
  EXPECT_EQ(make(scene, {.time = 0.010}).step, 10);
  EXPECT_EQ(make(scene).step, 1);
  std::string cause;
  EXPECT_FALSE(study::make_linear_system(scene, {.number = 101}, 1, cause));
  EXPECT_NE(cause.find("no such step"), std::string::npos) << cause;
  EXPECT_NE(cause.find("100"), std::string::npos) << cause;
}

TEST(LinearSystem, EveryUnknownHasAnOwner) {
  for (const bool spatial : {true, false}) {
    scene::Scene chain = test::make_chain(2);
    if (spatial) chain.without = {"planar"};
    const LinearSystem s = make(chain);
    int next = 0;
    bool has_hinge = false;
    for (const study::UnknownBlock& b : s.blocks) {
      EXPECT_EQ(b.first, next);
      next += b.count;
      has_hinge |= b.owner == "joint 'hinge1'" && b.count == (spatial ? 5 : 2) &&
                   b.components ==
                       (spatial ? "multipliers: along 1; along 2; along 3; axis 1 of the first normal to axis 3 of the "
                                  "second; axis 2 of the first normal to axis 3 of the second"
                                : "multipliers: along 1; along 2");
    }
    EXPECT_EQ(next, s.matrix.size);
    EXPECT_TRUE(has_hinge);
  }
}

TEST(LinearSystem, SingularMatricesAreHandedOutWithTheirTrouble) {
  scene::Scene s = make_cantilever();
  s.joints.clear();  // floats
  const LinearSystem system = make(s);
  EXPECT_GT(system.matrix.size, 0);
  EXPECT_TRUE(system.solution.empty());
  EXPECT_NE(system.trouble.find("singular"), std::string::npos) << system.trouble;
}

/// F (S + P) = 1 in the units of the scene; condensing what is left over of S to the rest gives the Schur complement of
/// the exported matrix.
TEST(LinearSystem, InterfacesHaveTheirMatrices) {
  for (const scene::SolverForm form : {scene::SolverForm::local, scene::SolverForm::augmented}) {
    scene::Scene s = make_cantilever();
    s.solver.depth = 1;
    s.solver.form = form;
    std::string cause;
    const auto system = study::make_linear_system(s, {}, 1, cause, "0");
    ASSERT_TRUE(system && system->interface) << cause;
    const study::InterfaceSystem& interface = *system->interface;
    const std::size_t n = interface.unknowns.size();
    ASSERT_GT(n, 0u);
    ASSERT_EQ(interface.flexibility.size(), n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0.0, size = i == j ? 1.0 : 0.0;
        for (std::size_t k = 0; k < n; ++k) {
          const double term =
              interface.flexibility[k * n + i] * (interface.stiffness[j * n + k] + interface.penalty[j * n + k]);
          sum += term;
          size += std::abs(term);
        }
        EXPECT_NEAR(sum, i == j ? 1.0 : 0.0, 1e-10 * size);
      }
    EXPECT_FALSE(study::make_linear_system(s, {}, 1, cause, "0.7"));
    EXPECT_NE(cause.find("no sub-domain \"0.7\""), std::string::npos) << cause;
  }
}

}  // namespace
}  // namespace bough
