/// Decisions of the plan apart from the reduction of unknowns (reduce.cpp), each with its condition.
#include <algorithm>
#include <array>
#include <cstdio>

#include "bough/scene/analysis_kinds.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;

bool Plan::took(const std::string& decision) const {
  return std::any_of(decisions.begin(), decisions.end(),
                     [&](const Decision& d) { return d.name == decision && d.taken; });
}

bool Builder::is_barred(const std::string& decision) const {
  static const std::array<std::string, 3> of_symmetry{"planar", "line", "translation"};
  if (scene::type_of(scene.analysis.kind).wants_all_motions &&
      std::find(of_symmetry.begin(), of_symmetry.end(), decision) != of_symmetry.end())
    return true;
  return std::find(scene.without.begin(), scene.without.end(), decision) != scene.without.end();
}

void Builder::decide(const std::string& name, const std::string& what, bool holds, const std::string& reason) {
  const std::vector<std::string>& names = scene::decision_names();
  Decision d{name, what, reason};
  d.can_be_barred = std::find(names.begin(), names.end(), name) != names.end();
  d.barred = is_barred(name);
  d.taken = holds && !d.barred;
  plan.decisions.push_back(d);
}

namespace {

/// Nanoseconds of residuals below which starting a task costs more than a second thread saves. Measured: a chain of 64
/// links of four beam elements takes 0.29 ms per step on one thread and 0.34 on two, one of 96 links 0.46 and 0.46; in
/// a plane 128 links take 0.22 and 0.245, 192 links 0.34 and 0.325.
constexpr double task_break_even = 150e3;

/// Break-even for sub-domains in lockstep, where few sub-domains leave lanes empty: chains of 16 links gain a fifth or
/// more, spin_up, four_bar_misaligned and flying_spaghetti of the gallery lose as much.
constexpr double lanes_break_even = 25e3;

/// Number of loops of the structure above which the cost of a factorization dominates a step, so that factoring the
/// symmetric part pays for additional iterations: a lattice of 9 by 9 nodes.
constexpr int loops_of_lattices = 64;

std::string count_of(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Loads without a potential: loads that follow rotations, moments that do not, and the Coriolis terms of a moving
/// frame in which the scene is described. In a plane a moment has a potential in either case.
std::string obstacle_to_potential(const Plan& plan, bool in_plane) {
  for (std::size_t id = 0; id < plan.directory.size(); ++id) {
    std::string obstacle;
    with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::load) {
        const auto force = lanes::linear_part(e.wrench), moment = lanes::angular_part(e.wrench);
        const bool follows = e.follows && (!in_plane || lanes::dot(force, force) > 0.0);
        if (follows || (!in_plane && lanes::dot(moment, moment) > 0.0))
          obstacle = "'" + plan.element_owner[id] + (e.follows ? "' follows rotations" : "' is a dead moment");
      }
    });
    if (!obstacle.empty()) return obstacle;
  }
  if (plan.num_driving_signals > 0) return "signals are unknowns beside the motions";
  return plan.frames.empty() ? "" : "frames move, which brings Coriolis terms";
}

}  // namespace

void Builder::settle() {
  const bool dynamic = plan.is_dynamic;
  for (const std::string& name : scene::retired_decision_names())
    if (is_barred(name))
      plan.notes.push_back("\"without\" names '" + name +
                           "', a simplification that is no longer made: it changes nothing");
  char text[120];
  std::size_t damped = 0, rows = 0;
  double work = 0.0;
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    work += 1e9 * E::cost.alone * static_cast<double>(array.size());
    for (const E& e : array) {
      damped += dissipates(e) ? 1 : 0;
    }
  });
  for (const JointPlan& j : plan.joints) rows += j.rows.size();
  for (const HeldNode& h : plan.held)
    for (int j : h.joints) rows -= plan.joints[static_cast<std::size_t>(j)].rows.size();
  const bool had_rows = !plan.held.empty();

  decide("reuse",
         "a factor serves again, over iterations and steps of one size, while it shrinks the changes to 0.03 of what "
         "they were; "
         "tangents are not even evaluated meanwhile. Taken in dynamics with Newton's full iteration",
         dynamic && scene.analysis.newton == scene::Newton::full,
         !dynamic                                         ? "statics takes a new tangent each time"
         : scene.analysis.newton == scene::Newton::single ? "one solution a step is asked for, with its own tangent"
                                                          : "steps of one size give nearly the same matrix");
  // Follower loads and dead moments are not conservative; moving frames cause Coriolis terms.
  std::string obstacle = obstacle_to_potential(plan, false);
  plan.not_conservative = obstacle_to_potential(plan, plan.unknowns.motions != Motions::spatial);
  int edges = 0;
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      int ends = 0;
      for (const Port& p : e.ports) ends += p.node != elements::ground ? 1 : 0;
      edges += std::max(0, ends - 1);
    });
  const int loops = edges - static_cast<int>(plan.nodes.size()) + 1;
  const bool is_local = scene.solver.form == scene::SolverForm::local;
  if (obstacle.empty() && plan.is_dynamic && scene.analysis.integrator == scene::Integrator::variational)
    obstacle = "the variational integrator's matrix is not symmetric";
  if (obstacle.empty() && !is_local) obstacle = "the form of the solver is not \"local\"";
  const bool conservative = obstacle.empty();
  std::snprintf(text, sizeof text, "%d loops, symmetric parts pay from %d on", std::max(0, loops), loops_of_lattices);
  decide("symmetric",
         "the symmetric parts of tangents are factored, L D L^T: half the work of L U, factors of half the size. "
         "Tangents in body increments are symmetric at equilibrium, but for gyroscopic terms. Taken where no load "
         "follows, no dead moment acts, no frame moves and loops make factorizations heavy; given up in a run where "
         "Newton's iteration suffers",
         conservative && loops >= loops_of_lattices, conservative ? text : obstacle);
  const bool one_matrix = scene.solver.form == scene::SolverForm::monolithic;
  const bool is_augmented = scene.solver.form == scene::SolverForm::augmented;
  std::snprintf(
      text, sizeof text,
      "one evaluation of the elements in space is about %.0f us of work; lanes are worth filling above %.0f us",
      1e-3 * work, 1e-3 * lanes_break_even);
  decide("lanes",
         "equal sub-domains are analysed once, and factored eight at a time. Taken unless the solver is of form "
         "\"monolithic\" or \"augmented\" or the scene small: a few sub-domains leave most lanes empty",
         !one_matrix && !is_augmented && work >= lanes_break_even,
         one_matrix     ? "the solver is monolithic"
         : is_augmented ? "the form \"augmented\" condenses one interface at a time"
                        : text);
  const double own_work = plan.with_group([]<class G>() { return elements::residual_part<G>; }) * work;
  std::snprintf(text, sizeof text, "one evaluation of the elements is about %.0f us of work; tasks pay above %.0f us",
                1e-3 * own_work, 1e-3 * task_break_even);
  decide("small", "one thread, no tasks. Taken where the work of an evaluation is below a measured break-even",
         own_work < task_break_even, text);

  decide("no velocities", "rates, inertia and gyroscopic terms are not entered. Taken in statics", !dynamic,
         dynamic ? "the analysis is dynamic" : "the analysis is static");
  decide("no damping", "no damper's terms are entered. Taken where no section, spring, bushing or joint has one",
         damped == 0, damped == 0 ? "nothing damps" : count_of(damped, "element damps", "elements damp"));
  decide("no multipliers", "the matrix has no constraint rows. Taken where no joint has a row that is solved for",
         rows == 0,
         rows > 0   ? count_of(rows, "constraint row", "constraint rows")
         : had_rows ? "the nodes that have constraints are held"
                    : "there are no constraints");
  decide("no moving frames", "no frame's motion is evaluated. Taken where no frame is driven", plan.frames.empty(),
         plan.frames.empty() ? "all frames are fixed" : count_of(plan.frames.size(), "frame moves", "frames move"));
  decide("no checks", "balances, violations and local errors are not evaluated. Taken with /output/checks false",
         !scene.output.checks, scene.output.checks ? "/output/checks is true" : "/output/checks is false");
  decide("no pictures", "the moving structure is not written. Taken unless /output/motion is true",
         !scene.output.motion, scene.output.motion ? "/output/motion is true" : "/output/motion is false");
  decide("no sensors", "nothing is measured but the time. Taken where the scene has none", scene.sensors.empty(),
         scene.sensors.empty() ? "the scene has none" : count_of(scene.sensors.size(), "sensor", "sensors"));
}

}  // namespace bough::plan
