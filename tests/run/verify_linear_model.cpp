/// Linear models against closed forms, frequency responses, modes and runs in time.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "bough/records/linear_model.hpp"
#include "table_seen.hpp"

namespace bough::verify {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using support::scene_of;
using support::text;

constexpr double pi = std::numbers::pi;

MatrixXd dense(const records::DenseMatrix& a) {
  MatrixXd m(a.rows, a.columns);
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.columns; ++j) m(i, j) = a.value[static_cast<std::size_t>(i * a.columns + j)];
  return m;
}
MatrixXd dense(const records::SparseEntries& a) {
  MatrixXd m = MatrixXd::Zero(a.rows, a.columns);
  for (std::size_t k = 0; k < a.value.size(); ++k) m(a.row[k], a.column[k]) += a.value[k];
  return m;
}

std::shared_ptr<const records::LinearModel> model_of(const scene::Scene& scene) {
  const support::Outcome outcome = support::run_ok(scene);
  EXPECT_TRUE(outcome.summary.linear_model != nullptr);
  return outcome.summary.linear_model;
}

MatrixXcd minimal_response(const records::LinearModel& model, Complex s) {
  const MatrixXd A = dense(model.minimal.A);
  const MatrixXcd pencil = s * MatrixXcd::Identity(A.rows(), A.cols()) - A.cast<Complex>();
  return dense(model.minimal.C).cast<Complex>() * pencil.partialPivLu().solve(dense(model.minimal.B).cast<Complex>()) +
         dense(model.minimal.D).cast<Complex>();
}
MatrixXcd descriptor_response(const records::LinearModel& model, Complex s) {
  const MatrixXcd pencil = s * dense(model.E).cast<Complex>() - dense(model.A).cast<Complex>();
  return dense(model.C).cast<Complex>() * pencil.fullPivLu().solve(dense(model.B).cast<Complex>()) +
         dense(model.D).cast<Complex>();
}

/// Two rods that hang on hinges with springs and dampers, and a strip that hangs on the second; pushed and driven.
std::string hanging(const std::string& analysis, const std::string& push = "0") {
  return R"({"gravity": [0, 0, -9.81],
    "sections": [{"name": "strip", "stiffness": {"EA": 1e5, "GA2": 4e4, "GA3": 4e4, "GJ": 20, "EI2": 10, "EI3": 10},
                  "damping": {"time": 0.01}, "mass": {"mass_per_length": 0.3, "rotary": [2e-3, 1e-3, 1e-3]}}],
    "bodies": [{"name": "one", "mass": 2, "inertia": [0.2, 0.2, 1e-2], "position": [0, 0, -0.5]},
               {"name": "two", "mass": 1, "inertia": [0.1, 0.1, 1e-2], "position": [0, 0, -1.5]}],
    "nodes": [{"name": "upper", "position": [0, 0, -2]}, {"name": "tip", "position": [0.4, 0, -2.3]}],
    "beams": [{"name": "strip", "section": "strip", "start": "upper", "end": "tip", "elements": 2, "order": 2}],
    "joints": [{"name": "top", "kind": "revolute", "first": "ground", "second": "one", "position": [0, 0, 0], "axis": [0, 1, 0],
                "forces": [{"damping": 0.3}]},
               {"name": "knee", "kind": "revolute", "first": "one", "second": "two", "position": [0, 0, -1], "axis": [0, 1, 0],
                "forces": [{"stiffness": 5, "damping": 0.2, "effort": )" +
         push + R"(}]},
               {"name": "weld", "kind": "fixed", "first": "two", "second": "upper"}],
    "loads": [{"name": "wind", "at": "tip", "force": [0.3, 1, 0], "law": 0}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}, {"name": "pace", "kind": "velocity", "at": "tip"},
                {"name": "knee", "kind": "joint_angle", "joint": "knee"}, {"name": "jerk", "kind": "acceleration", "at": "two"},
                {"name": "hung", "kind": "joint_reaction", "joint": "top"},
                {"name": "root", "kind": "section_force", "beam": "strip", "station": 0.1}],
    "analysis": )" +
         analysis + "}";
}
const char* const ports = R"("inputs": ["wind", "knee"])";

TEST(LinearModel, of_an_oscillator_is_its_closed_form) {
  const auto model = model_of(scene_of(R"({"bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
                "forces": [{"stiffness": 50, "damping": 4}]}],
    "loads": [{"name": "push", "at": "mass", "force": [3, 0, 0], "law": 0}],
    "sensors": [{"name": "mass", "kind": "position", "at": "mass"}, {"name": "shake", "kind": "acceleration", "at": "mass"}],
    "analysis": {"kind": "linear_model", "inputs": ["push"]}})"));
  ASSERT_EQ(model->why_not_minimal, "");
  ASSERT_EQ(model->minimal.states.size(), 2U);
  EXPECT_EQ(model->minimal.states[0].name, "mass.u1");
  EXPECT_EQ(model->minimal.states[1].name, "mass.v1");
  EXPECT_EQ(model->minimal.states[1].unit, "m/s");
  EXPECT_EQ(model->inputs[0].name, "push");
  const MatrixXd A = dense(model->minimal.A), B = dense(model->minimal.B), C = dense(model->minimal.C),
                 D = dense(model->minimal.D);
  EXPECT_NEAR(A(0, 1), 1.0, 1e-15);
  EXPECT_NEAR(A(1, 0), -25.0, 1e-12);
  EXPECT_NEAR(A(1, 1), -2.0, 1e-13);
  EXPECT_NEAR(B(1, 0), 1.5, 1e-14);
  EXPECT_NEAR(C(0, 0), 1.0, 1e-13);
  EXPECT_NEAR(C(3, 0), -25.0, 1e-10);  // shake.ax
  EXPECT_NEAR(D(3, 0), 1.5, 1e-12);
}

TEST(LinearModel, both_forms_have_the_frequency_response_of_the_direct_solution) {
  const auto model = model_of(scene_of(hanging(std::string(R"({"kind": "linear_model", )") + ports + "}")));
  ASSERT_EQ(model->why_not_minimal, "");
  const support::Outcome outcome = support::run_ok(
      scene_of(hanging(std::string(R"({"kind": "response", "frequencies": [0.2, 1.3, 7, 60], )") + ports + "}")));
  const TableSeen seen(outcome, "response");
  for (std::size_t k = 0; k < seen.count(); ++k) {
    const Complex s(0.0, 2.0 * pi * seen.number(k, "frequency"));
    const MatrixXcd minimal = minimal_response(*model, s), descriptor = descriptor_response(*model, s);
    for (std::size_t u = 0; u < model->inputs.size(); ++u) {
      double most = 0.0;
      for (std::size_t y = 0; y < model->outputs.size(); ++y)
        most = std::max(most, std::abs(minimal(static_cast<Index>(y), static_cast<Index>(u))));
      for (std::size_t y = 0; y < model->outputs.size(); ++y) {
        const std::string name = model->outputs[y].name + " by " + model->inputs[u].name;
        const Complex direct =
            std::polar(seen.number(k, name + " amplitude"), seen.number(k, name + " phase") * pi / 180);
        const double allowed = 1e-8 * std::abs(direct) + 4e-9 * most;
        EXPECT_LT(std::abs(minimal(static_cast<Index>(y), static_cast<Index>(u)) - direct), allowed)
            << name << " " << k;
        EXPECT_LT(std::abs(descriptor(static_cast<Index>(y), static_cast<Index>(u)) - direct), allowed)
            << name << " " << k;
      }
    }
  }
}

TEST(LinearModel, eigenvalues_of_the_minimal_form_are_those_of_modes) {
  const auto model = model_of(scene_of(hanging(std::string(R"({"kind": "linear_model", )") + ports + "}")));
  const support::Outcome outcome =
      support::run_ok(scene_of(hanging(R"({"kind": "modes", "count": 4, "damping": true})")));
  const TableSeen modes(outcome, "modes");
  const Eigen::VectorXcd values = Eigen::EigenSolver<MatrixXd>(dense(model->minimal.A)).eigenvalues();
  for (std::size_t k = 0; k < modes.count(); ++k) {
    const Complex lambda(modes.number(k, "real_part"), modes.number(k, "imaginary_part"));
    double away = 1e300;
    for (Index i = 0; i < values.size(); ++i) away = std::min(away, std::abs(values[i] - lambda));
    EXPECT_LT(away, 1e-7 * std::abs(lambda)) << lambda;
  }
}

/// A step of the torque of the knee by e: a run differs from the model by a term in e^2.
TEST(LinearModel, the_remainder_of_a_step_of_a_run_is_of_second_order) {
  const auto model = model_of(scene_of(hanging(std::string(R"({"kind": "linear_model", )") + ports + "}")));
  const double end = 0.8, h = 5e-4;
  const MatrixXd A = dense(model->minimal.A), B = dense(model->minimal.B), C = dense(model->minimal.C),
                 D = dense(model->minimal.D);
  MatrixXd whole = MatrixXd::Zero(A.rows() + 1, A.cols() + 1);
  whole.topLeftCorner(A.rows(), A.cols()) = A;
  whole.topRightCorner(A.rows(), 1) = B.col(1);
  const MatrixXd flow = (whole * end).exp();
  const Eigen::VectorXd y = C * flow.topRightCorner(A.rows(), 1) + D.col(1);
  double before = 0.0;
  for (const double e : {0.04, 0.08}) {
    // The load of time 0 is part of the equilibrium, so that the torque begins just after.
    const std::string law =
        R"({"kind": "piecewise", "pieces": [{"start": 0, "law": 0}, {"start": 1e-9, "law": )" + text(e) + "}]}";
    const support::Outcome run = support::run_ok(scene_of(hanging(
        R"({"kind": "dynamic", "start": "equilibrium", "tolerance": 1e-10, "spectral_radius": 0.9, "end_time": )" +
            text(end) + R"(, "step_size": )" + text(h) + "}",
        law)));
    double left = 0.0, size = 0.0;
    for (std::size_t k = 0; k < model->outputs.size(); ++k) {
      const std::string& name = model->outputs[k].name;
      if (name != "tip.x" && name != "tip.z" && name != "knee") continue;
      const double change = run.history.last(name) - run.history.first(name);
      left += std::pow(change - e * y[static_cast<Index>(k)], 2);
      size += change * change;
    }
    left = std::sqrt(left);
    std::printf("| step of %.2f N m | change %.5e, remainder %.5e |\n", e, std::sqrt(size), left);
    if (before > 0.0) {
      EXPECT_NEAR(left / before, 4.0, 0.3);
    }
    before = left;
  }
}

TEST(LinearModel, inputs_that_prescribe_a_motion_have_a_descriptor_form_alone) {
  const auto model = model_of(scene_of(R"({"nodes": [{"name": "base"}],
    "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
    "motions": [{"name": "table", "at": "base", "x": 0, "y": 0, "z": 0, "rotation": "hold"}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "base", "second": "mass", "axis": [1, 0, 0],
                "forces": [{"stiffness": 800, "damping": 4}]}],
    "sensors": [{"name": "mass", "kind": "position", "at": "mass"}],
    "analysis": {"kind": "linear_model", "inputs": [{"of": "table", "component": "x"}]}})"));
  EXPECT_NE(model->why_not_minimal.find("prescribes a motion"), std::string::npos) << model->why_not_minimal;
  const Complex s(0.0, 12.0), exact = (800.0 + 4.0 * s) / (2.0 * s * s + 4.0 * s + 800.0);
  EXPECT_LT(std::abs(descriptor_response(*model, s)(0, 0) - exact), 1e-9);
}

}  // namespace
}  // namespace bough::verify
