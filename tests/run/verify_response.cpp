/// Frequency responses against closed forms, against runs in time, and what they refuse.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "bough/io/read_scene.hpp"
#include "table_seen.hpp"

namespace bough::verify {
namespace {

using Complex = std::complex<double>;
using support::scene_of;
using support::text;

constexpr double pi = std::numbers::pi;

Complex response_of(const TableSeen& seen, std::size_t row, const std::string& name) {
  return std::polar(seen.number(row, name + " amplitude"), seen.number(row, name + " phase") * pi / 180.0);
}

std::string list_of(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "[" : ", ") + text(value);
  return list + "]";
}

/// The steel cantilever of the reference, damped with this tau.
TableSeen cantilever(int elements, int order, double tau, const std::vector<double>& angular) {
  const double E = 2.1e11, area = 0.01, inertia = 1e-4 / 12.0, GA = E / 2.6 * area * 5.0 / 6.0, rho = 7850.0;
  std::vector<double> hertz;
  for (const double w : angular) hertz.push_back(w / (2.0 * pi));
  return TableSeen(support::run_ok(scene_of(
                       R"({"sections": [{"name": "bar", "stiffness": {"EA": )" + text(E * area) + R"(, "GA2": )" +
                       text(GA) + R"(, "GA3": )" + text(GA) + R"(, "GJ": 1e6, "EI2": )" + text(E * inertia) +
                       R"(, "EI3": )" + text(E * inertia) + R"(}, "damping": {"time": )" + text(tau) +
                       R"(}, "mass": {"mass_per_length": )" + text(rho * area) + R"(, "rotary": [)" +
                       text(2.0 * rho * inertia) + ", " + text(rho * inertia) + ", " + text(rho * inertia) + R"(]}}],
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "tip", "elements": )" +
                       std::to_string(elements) + R"(, "order": )" + std::to_string(order) + R"(}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "loads": [{"name": "shaker", "at": "tip", "force": [0, 0, 1], "law": 0}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}, {"name": "turn", "kind": "rotation", "at": "tip"},
                {"name": "pace", "kind": "velocity", "at": "tip"}, {"name": "jerk", "kind": "acceleration", "at": "tip"},
                {"name": "root", "kind": "section_force", "beam": "arm", "station": 0},
                {"name": "clamp", "kind": "joint_reaction", "joint": "clamp"}],
    "analysis": {"kind": "response", "inputs": ["shaker"], "frequencies": )" +
                       list_of(hertz) + "}}")),
                   "response");
}

TEST(Response, receptance_of_a_timoshenko_cantilever_is_that_of_the_closed_form) {
  const support::Table exact = support::reference("receptance_cantilever.csv");
  std::vector<double> angular;
  for (const double w : exact.times) angular.push_back(w);
  for (const double tau : {0.0, 1e-5}) {
    const TableSeen seen = cantilever(40, 3, tau, angular);
    double worst = 0.0;
    for (std::size_t k = 0; k < seen.count(); ++k) {
      const Complex H = tau == 0.0 ? Complex(exact.rows[k][0]) : Complex(exact.rows[k][1], exact.rows[k][2]);
      const Complex slope(exact.rows[k][3], exact.rows[k][4]);
      const Complex found = response_of(seen, k, "tip.z");
      // An error of 1e-10 of a frequency is one of 1e-10 w dH/dw: next to a resonance that is more.
      const double near =
          std::abs(angular[k] - 520.8406417) < 1.0 || std::abs(angular[k] - 3121.5777654) < 1.0 ? 3e3 : 1;
      EXPECT_LT(std::abs(found - H), 3e-9 * near * std::abs(H)) << angular[k];
      worst = std::max(worst, std::abs(found - H) / (near * std::abs(H)));
      if (tau > 0.0) {
        const Complex turn = response_of(seen, k, "turn.ry");
        EXPECT_LT(std::min(std::abs(turn - slope), std::abs(turn + slope)), 3e-9 * near * std::abs(slope))
            << angular[k];
      }
      const Complex s(0.0, angular[k]);
      EXPECT_LT(std::abs(response_of(seen, k, "pace.vz") - s * found), 1e-11 * std::abs(s * found));
      EXPECT_LT(std::abs(response_of(seen, k, "jerk.az") - s * s * found), 1e-11 * std::abs(s * s * found));
    }
    std::printf("| receptance of the cantilever, tau %g | largest difference %.1e of it |\n", tau, worst);
  }
}

TEST(Response, receptance_converges_with_the_order_of_frequencies) {
  for (int order = 1; order <= 3; ++order) {
    const std::vector<double> w{300.0, 1000.0};
    const int mesh = order == 3 ? 3 : 8;
    const Complex exact[] = {2.843880247556161e-7 + Complex(0, -1.26805567122581e-9),
                             -6.281825627463434e-8 + Complex(0, -3.286954137535697e-10)};
    for (std::size_t k = 0; k < 2; ++k) {
      const double coarse = std::abs(response_of(cantilever(mesh, order, 1e-5, w), k, "tip.z") - exact[k]),
                   fine = std::abs(response_of(cantilever(2 * mesh, order, 1e-5, w), k, "tip.z") - exact[k]);
      EXPECT_NEAR(support::order_of(coarse, fine), 2.0 * order, 0.4) << order << " " << w[k];
    }
  }
}

/// m = 2 kg on k = 800 N/m and c = 4 N s/m, on a base that is moved along x.
std::string oscillator(const std::string& inputs, double damping = 4.0) {
  return R"({"nodes": [{"name": "base"}],
    "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
    "motions": [{"name": "table", "at": "base", "x": 0, "y": 0, "z": 0, "rotation": "hold"}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "base", "second": "mass", "axis": [1, 0, 0],
                "forces": [{"stiffness": 800, "damping": )" +
         text(damping) + R"(}]}],
    "loads": [{"name": "push", "at": "mass", "force": [3, 0, 0], "law": 0}],
    "sensors": [{"name": "mass", "kind": "position", "at": "mass"}, {"name": "way", "kind": "joint_displacement", "joint": "rail"},
                {"name": "shake", "kind": "acceleration", "at": "mass"}, {"name": "held", "kind": "force", "of": "table"}],
    "analysis": {"kind": "response", "inputs": [)" +
         inputs + R"(], "frequencies": {"from": 0.5, "to": 20, "count": 40}}})";
}

TEST(Response, an_oscillator_on_a_moved_base_answers_as_its_closed_form) {
  const TableSeen seen(
      support::run_ok(scene_of(oscillator(R"("push", {"of": "table", "component": "x"}, {"of": "rail"})"))),
      "response");
  ASSERT_EQ(seen.count(), 40U);
  for (std::size_t k = 0; k < seen.count(); ++k) {
    const double w = 2.0 * pi * seen.number(k, "frequency");
    const Complex s(0.0, w), stiff = 800.0 + 4.0 * s, whole = 2.0 * s * s + stiff;
    const auto is = [&](const std::string& name, Complex exact) {
      EXPECT_LT(std::abs(response_of(seen, k, name) - exact), 1e-11 * std::abs(exact)) << name << " at " << w;
    };
    is("mass.x by push", 3.0 / whole);
    is("mass.x by table.x", stiff / whole);
    is("way by table.x", -2.0 * s * s / whole);
    is("shake.ax by table.x", s * s * stiff / whole);
    is("mass.x by rail", 1.0 / whole);
    is("held.fx by table.x", 2.0 * s * s * stiff / whole);
  }
}

/// A disc that spins about x on a bushing, tilted by a moment about y:
///   (k - I w^2) a_y + i w J W a_z = M,  (k - I w^2) a_z - i w J W a_y = 0
/// seen from the ground. A point on its axis shows the tilt, and its rates without those of the spin.
TEST(Response, of_a_spinning_disc_is_seen_from_the_ground_with_its_gyroscopic_moments) {
  const double k = 900.0, I = 0.2, J = 0.35, W = 60.0;
  const TableSeen seen(support::run_ok(scene_of(R"({
    "bodies": [{"name": "disc", "mass": 3, "inertia": [0.35, 0.2, 0.2]}],
    "bushings": [{"name": "mount", "first": "ground", "second": "disc", "stiffness": [5e4, 5e4, 5e4, 0, 900, 900]}],
    "initial_velocities": [{"of": "disc", "angular_velocity": [60, 0, 0]}],
    "loads": [{"name": "tilt", "at": "disc", "moment": [0, 1, 0], "law": 0}],
    "sensors": [{"name": "axis", "kind": "position", "at": {"to": "disc", "position": [1, 0, 0]}},
                {"name": "pace", "kind": "velocity", "at": {"to": "disc", "position": [1, 0, 0]}},
                {"name": "shake", "kind": "acceleration", "at": {"to": "disc", "position": [1, 0, 0]}}],
    "analysis": {"kind": "response", "about": "start", "inputs": ["tilt"], "frequencies": [0.5, 2, 7, 19, 40]}})")),
                       "response");
  ASSERT_EQ(seen.count(), 5U);
  for (std::size_t row = 0; row < seen.count(); ++row) {
    const double w = 2.0 * pi * seen.number(row, "frequency");
    const Complex s(0.0, w), own = k - I * w * w, cross = s * J * W, det = own * own + cross * cross;
    const Complex y = cross / det, z = -own / det;  // a_z and -a_y
    const auto is = [&](const std::string& name, Complex exact) {
      EXPECT_LT(std::abs(response_of(seen, row, name) - exact), 1e-9 * std::abs(exact)) << name << " at " << w;
    };
    is("axis.y", y);
    is("axis.z", z);
    is("pace.vy", s * y);
    is("pace.vz", s * z);
    is("shake.ay", s * s * y);
    is("shake.az", s * s * z);
  }
}

TEST(Response, mean_squares_under_white_noise_are_those_of_the_closed_form) {
  // one-sided density G of the force per Hz: <x^2> = G / (4 k c)
  scene::Scene scene = scene_of(oscillator(R"({"of": "push", "spectrum": [[0, 0.5], [1000, 0.5]]})"));
  scene.analysis.linear.frequencies.clear();
  for (int k = 0; k <= 8000; ++k) scene.analysis.linear.frequencies.push_back(0.005 * k);
  const support::Outcome outcome = support::run_ok(scene);
  const TableSeen rms(outcome, "rms"), spectra(outcome, "spectra");
  EXPECT_EQ(rms.text(0, "output"), "mass.x");
  const double exact = std::sqrt(0.5 * 9.0 / (4.0 * 800.0 * 4.0));
  EXPECT_NEAR(rms.number(0, "rms"), exact, 1e-4 * exact);
  EXPECT_NEAR(spectra.number(0, "mass.x"), 0.5 * 9.0 / (800.0 * 800.0), 1e-12);
}

TEST(Response, undamped_structures_are_told_where_they_resonate_and_refused_at_a_resonance) {
  const support::Outcome outcome = support::run_ok(scene_of(oscillator("\"push\"", 0.0)));
  EXPECT_TRUE(says_one_of(outcome.summary.notes, "the structure resonates between 3."));
  scene::Scene at = scene_of(oscillator("\"push\"", 0.0));
  at.analysis.linear.frequencies = {1.0, 20.0 / (2.0 * pi)};
  const support::Outcome refused = support::run(at);
  EXPECT_FALSE(refused.ok());
  EXPECT_NE(refused.summary.cause.find("at 3.18309886 Hz there is no steady vibration under 'push'"), std::string::npos)
      << refused.summary.cause;
}

/// A weight on a strip that it bends far, damped, and shaken sideways: the amplitude of a long run.
TEST(Response, about_a_bent_equilibrium_is_the_steady_vibration_of_a_run) {
  const auto scene = [](const std::string& law, const std::string& analysis) {
    return scene_of(R"({"gravity": [0, 0, -9.81],
      "sections": [{"name": "strip", "stiffness": {"EA": 1e5, "GA2": 4e4, "GA3": 4e4, "GJ": 20, "EI2": 10, "EI3": 10},
                    "damping": {"time": 0.1}, "mass": {"mass_per_length": 1e-3, "rotary": [2e-7, 1e-7, 1e-7]}}],
      "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
      "bodies": [{"name": "weight", "mass": 2, "inertia": [1e-3, 1e-3, 1e-3], "position": [1, 0, 0]}],
      "beams": [{"name": "strip", "section": "strip", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": 6, "order": 2}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"},
                 {"name": "grip", "kind": "fixed", "first": "tip", "second": "weight"}],
      "loads": [{"name": "shaker", "at": "weight", "force": [0, 2e-4, 1e-4], "law": )" +
                    law + R"(}],
      "sensors": [{"name": "weight", "kind": "position", "at": "weight"}, {"name": "twist", "kind": "section_force", "beam": "strip", "station": 0.3}],
      "analysis": )" +
                    analysis + "}");
  };
  const double f = 0.55, period = 1.0 / f;
  const TableSeen seen(
      support::run_ok(scene("0", R"({"kind": "response", "inputs": ["shaker"], "frequencies": [)" + text(f) + "]}")),
      "response");
  const double steps = 1000.0, end = 30.0 * period;
  const support::Outcome run = support::run_ok(
      scene(R"({"kind": "harmonic", "amplitude": 1, "omega": )" + text(2.0 * pi * f) + "}",
            R"({"kind": "dynamic", "start": "equilibrium", "end_time": )" + text(end) + R"(, "step_size": )" +
                text(period / steps) + R"(, "spectral_radius": 0.6, "tolerance": 1e-10})"));
  for (const std::string name : {"weight.y", "weight.z", "weight.x", "twist.M2"}) {
    const std::vector<double> values = run.history.of(name);
    Complex amplitude = 0.0;  // of the last period, of sin(w t)
    for (std::size_t k = values.size() - static_cast<std::size_t>(steps); k < values.size(); ++k)
      amplitude += values[k] * std::polar(2.0 / steps, pi / 2.0 - 2.0 * pi * f * run.history.times[k]);
    const Complex found = response_of(seen, 0, name);
    std::printf("| %s of a bent strip | response %.8e %.4f, run %.8e %.4f |\n", name.c_str(), std::abs(found),
                std::arg(found), std::abs(amplitude), std::arg(amplitude));
    EXPECT_LT(std::abs(found - amplitude), 1e-4 * std::abs(found)) << name;
  }
}

TEST(Response, what_cannot_be_an_input_is_refused_with_what_to_do) {
  const auto problems = [](const std::string& inputs) {
    const io::SceneFile file = io::read_scene_text("{\"schema_version\": 1, " + oscillator(inputs).substr(1), "test");
    return file.problems.empty() ? std::string() : file.problems.front().text();
  };
  EXPECT_NE(problems("\"pusch\"").find("did you mean 'push'"), std::string::npos);
  EXPECT_NE(problems("\"table\"").find(R"("component": "x", "y" or "z")"), std::string::npos) << problems("\"table\"");
  EXPECT_NE(problems("\"push\", \"push\"").find("named twice"), std::string::npos);
  EXPECT_NE(problems(R"({"of": "rail", "component": "angle"})").find("no drive or effort along this coordinate"),
            std::string::npos);
}

}  // namespace
}  // namespace bough::verify
