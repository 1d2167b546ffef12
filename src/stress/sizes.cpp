/// Sub-domains of all sizes and supports: floating ones, one element each, a hub of a thousand, a chain of a hundred
/// thousand, a single body.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

double largest_difference(const run::MemoryRun& a, const run::MemoryRun& b, double scale) {
  double most = a.rows.size() == b.rows.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < std::min(a.rows.size(), b.rows.size()); ++r)
    for (std::size_t c = 0; c < a.header.columns.size(); ++c)
      most = std::max(most, std::abs(a.rows[r].values[c] - b.rows[r].values[c]) / scale);
  return most;
}

/// A free beam, thrown and spun: all its sub-domains float.
scene::Scene free_beam(int elements) {
  scene::Scene s;
  s.name = "free beam";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.sections = {scene::make_section("s", 1e4, 1e4, 1e4, 500, 500, 500)};
  scene::set_mass(s.sections[0], 1.0, 20.0, 10.0, 10.0);
  s.nodes = {scene::make_node("a", Vec3::zero()), scene::make_node("b", {{10, 0, 0}})};
  s.beams = {scene::make_beam("beam", "s", "a", "b", elements, 1)};
  scene::InitialVelocity thrown;
  thrown.of = "beam";
  thrown.velocity = {{1.0, 20.0, 3.0}};
  thrown.angular_velocity = {{0.3, 0.5, 1.0}};
  s.initial_velocities = {thrown};
  s.sensors = {scene::make_point_sensor("a", scene::SensorKind::position, "a"),
               scene::make_point_sensor("b", scene::SensorKind::position, "b")};
  s.analysis.end_time = 2.0;
  s.analysis.step_size = 0.02;
  s.analysis.tolerance = 1e-11;
  return s;
}

void floating(Bench& bench) {
  scene::Scene s = free_beam(32);
  s.solver.depth = 0;
  const run::MemoryRun whole = bench.run(s, "one domain");
  double worst = 0.0;
  for (int depth = 1; depth <= 5; ++depth) {
    s.solver.depth = depth;
    worst = std::max(worst, largest_difference(whole, bench.run(s, "depth " + std::to_string(depth)), 10.0));
  }
  bench.round_off_error("places at depths 1 to 5 against one domain", worst, 1e-10);
  for (const scene::SolverForm form : {scene::SolverForm::global, scene::SolverForm::hybrid}) {
    s.solver.form = form;
    s.solver.depth = 3;
    const bool is_global = form == scene::SolverForm::global;
    bench.round_off_error(is_global ? "places with global multipliers" : "places with the hybrid",
                          largest_difference(whole, bench.run(s), 10.0), 1e-10);
  }
}

void one_element_each(Bench& bench) {
  scene::Scene s = free_beam(17);
  s.solver.depth = 0;
  const run::MemoryRun whole = bench.run(s, "one domain");
  s.solver.depth = -1;
  s.solver.leaf_size = 1;
  const run::MemoryRun single = bench.run(s, "one element each");
  double leaves = 0.0, widest = 0.0;
  for (const auto& [name, value] : single.summary.solver) {
    if (name == "leaves") leaves = value;
    if (name == "interface_unknowns_max") widest = value;
  }
  bench.figure("elements without a sub-domain of their own", 17.0 - leaves, 0.0);
  bench.figure("unknowns of the widest interface: two nodes", widest, 12.0);
  bench.round_off_error("places against one domain", largest_difference(whole, single, 10.0), 1e-10);
  scene::Scene two = free_beam(2);
  two.solver.depth = 0;
  const run::MemoryRun base = bench.run(two, "two elements");
  two.solver.depth = 1;
  const run::MemoryRun cut = bench.run(two, "two elements, cut at their node");
  bench.round_off_error("places of two elements with an interface of one node", largest_difference(base, cut, 10.0),
                        1e-10);
}

/// Spokes in a plane from a rim that is clamped to one node; small loads, so that the closed form of one bar adds up.
void hub(Bench& bench) {
  const int spokes = bench.shorten(1000, 200);
  const double EA = 1e3, GA = 4e2, EI = 1.0, F = 1e-3;
  scene::Scene s;
  s.name = "hub";
  s.sections = {scene::make_section("spoke", EA, GA, GA, 0.8, EI, EI)};
  s.nodes = {scene::make_node("hub", Vec3::zero())};
  for (int k = 0; k < spokes; ++k) {
    const double angle = 2.0 * M_PI * k / spokes;
    const std::string n = std::to_string(k);
    const Vec3 at{{std::cos(angle), std::sin(angle), 0.0}};
    s.nodes.push_back(scene::make_node("rim " + n, at));
    s.beams.push_back(scene::make_beam("spoke " + n, "spoke", "hub", "rim " + n, 2, 3));
    s.beams.back().axis_2 = {{0.0, 0.0, 1.0}};
    s.joints.push_back(scene::make_joint("clamp " + n, scene::JointKind::fixed, "", at, "rim " + n, Vec3::zero()));
  }
  s.point_loads = {scene::make_load("hub", {{F, 0.0, 0.0}})};
  s.sensors = {scene::make_point_sensor("hub", scene::SensorKind::position, "hub")};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.tolerance = 1e-11;
  const run::MemoryRun run = bench.run(s);
  const double phi = 12.0 * EI / GA;  // L = 1
  const double stiffness = 0.5 * spokes * (EA + 12.0 * EI / (1.0 + phi));
  bench.error("displacement of the hub", std::abs(run.final("hub.x") * stiffness / F - 1.0), 1e-7);
  bench.error("displacement across the load", std::abs(run.final("hub.y")) * stiffness / F, 1e-7);
}

/// A bar of many elements, pulled at one end by a force that rises and falls smoothly. Until the wave returns, the end
/// moves as on an infinite bar, u(t) = c / (E A) int F (d'Alembert). The chain is not supported; the wave has not
/// reached its far end yet.
void long_chain(Bench& bench) {
  const int elements = bench.shorten(100000, 10000);
  const double EA = 1e6, mass = 1.0, c = std::sqrt(EA / mass), length = 0.1, F = 10.0, rise = 40.0 * length / c;
  scene::Scene s;
  s.name = "long chain";
  s.sections = {scene::make_section("bar", EA, 4e5, 4e5, 1e3, 1e3, 1e3)};
  scene::set_mass(s.sections[0], mass, 2e-3, 1e-3, 1e-3);
  s.nodes = {scene::make_node("root", Vec3::zero()), scene::make_node("tip", {{elements * length, 0, 0}})};
  s.beams = {scene::make_beam("bar", "bar", "root", "tip", elements, 1)};
  s.joints = {scene::make_weld("clamp", "root")};
  s.point_loads = {scene::make_load("tip", {{F, 0, 0}})};
  // F sin^2(pi t / rise) = F/2 (1 - cos(2 pi t / rise))
  const double w = 2.0 * M_PI / rise;
  s.point_loads[0].law = laws::make_harmonic(-0.5, w, 0.5 * M_PI, 0.5);
  s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, "tip")};
  s.analysis.step_size = rise / 40.0;
  s.analysis.end_time = 1.5 * rise;
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-9;
  s.output.checks = false;
  const run::MemoryRun run = bench.run(s);
  const double full = c / EA * F * 0.5 * s.analysis.end_time;
  double worst = 0.0;
  for (const records::HistoryRow& row : run.rows) {
    const double exact = c / EA * F * 0.5 * (row.time - std::sin(w * row.time) / w);
    worst = std::max(worst, std::abs(row.values[run.column("tip.x")] - elements * length - exact) / full);
  }
  bench.tell("elements", elements);
  bench.error("displacement of the pulled end", worst, 1e-2);
  bench.figure(
      "Newton iterations a step",
      static_cast<double>(run.summary.steps.newton_iterations) / static_cast<double>(run.summary.steps.accepted), 6.0);
}

/// Slender cantilevers of more and more elements. Shear and extension are EA L^2 / EI times as stiff as bending, and n
/// elements in a row are n^2 times as flexible as one. Condition and lost digits grow with the product. Where digits
/// are lost, the run has to report it.
void long_chain_statics(Bench& bench) {
  const int most = bench.shorten(100000, 10000);
  const double EA = 1e10, GA = 5e9, EI = 100.0, F = 1e-6;
  double silent = 0.0, beyond = 0.0;
  int lost_at = 0, doubted_at = 0;
  for (int n = 10; n <= most; n *= 10) {
    scene::Scene s = scene::make_cantilever(scene::make_section("s", EA, GA, GA, EI, EI, EI), 1.0, n, 1);
    s.point_loads = {scene::make_load("tip", {{0, F, 0}})};
    const run::MemoryRun run = bench.try_run(s);
    const std::string label = ", " + std::to_string(n) + " elements";
    const double exact = F * (1.0 / (3.0 * EI) + 1.0 / GA);
    const double mesh =
        F / (12.0 * EI * n * n);  // elements of order 1 are stiff by L^3 / (12 EI n^2) per unit of force
    const double error = run.ok() ? std::abs(run.final("tip.y") - exact + mesh) / exact : 1.0;
    if (run.ok())
      bench.tell("error beyond the mesh's" + label, error);
    else
      bench.say(std::to_string(n) + " elements: " + run.summary.cause);
    if (error > 1e-3 && run.summary.doubts.empty()) silent = std::max(silent, error);
    if (error > 1e-3 && lost_at == 0) lost_at = n;
    if (!run.summary.doubts.empty() && doubted_at == 0) doubted_at = n;
    for (const auto& [name, value] : run.summary.solver)
      if (name == "condition_estimate") {
        bench.tell("condition" + label, value);
        beyond = std::max(beyond, error / (10.0 * 0x1p-53 * value));
      }
  }
  bench.tell("elements at which the run is first doubted (0: none)", doubted_at);
  bench.tell("elements at which three digits are not left (0: none)", lost_at);
  bench.figure("largest error above 1e-3 that the run says nothing of", silent, 0.0);
  bench.figure("largest error over 10 u times the condition that the run tells", beyond, 1.0);
}

void one_body(Bench& bench) {
  scene::Scene s;
  s.name = "one body";
  s.gravity = {{0.0, 0.0, -9.81}};
  s.bodies = {scene::make_body("body", 2.0, {{0.4, 0.4, 0.4}}, {{1.0, 2.0, 3.0}})};
  scene::InitialVelocity thrown;
  thrown.of = "body";
  thrown.velocity = {{1.0, -2.0, 30.0}};
  thrown.angular_velocity = {{0.0, 0.0, 5.0}};
  s.initial_velocities = {thrown};
  s.sensors = {scene::make_point_sensor("body", scene::SensorKind::position, "body")};
  s.analysis.end_time = 5.0;
  s.analysis.step_size = 0.01;
  s.analysis.tolerance = 1e-12;
  // Parallel to the spin, gravity and velocity are constant in the body's axes, and the scheme is exact. Across it,
  // velocities rotate in the body's axes.
  s.initial_velocities[0].velocity = {{0.0, 0.0, 30.0}};
  const run::MemoryRun run = bench.run(s);
  const double t = s.analysis.end_time;
  bench.round_off_error("height after 5 s",
                        std::abs(run.final("body.z") - (3.0 + 30.0 * t - 0.5 * 9.81 * t * t)) / 50.0, 1e-12);
  bench.round_off_error("sideways", std::hypot(run.final("body.x") - 1.0, run.final("body.y") - 2.0), 1e-12);
}

}  // namespace

void add_sizes(std::vector<Definition>& table) {
  table.push_back(
      {"floating_sub_domains", "sizes",
       "a free beam cut at depths 1 to 5, and torn apart with global multipliers and the hybrid, moves as in "
       "one domain to 1e-10 of its length",
       floating});
  table.push_back({"one_element", "sizes",
                   "sub-domains of one element each, an interface of one node: as in one domain to 1e-10",
                   one_element_each});
  table.push_back({"hub", "sizes", "a node shared by 1000 beams: the stiffness of the spokes, added up, to 1e-7", hub});
  table.push_back({"long_chain", "sizes",
                   "1e5 elements in one chain in dynamics: the pulled end follows d'Alembert's solution to 1e-2 in 60 "
                   "steps, with at most six iterations a step",
                   long_chain});
  table.push_back(
      {"long_chain_statics", "sizes",
       "a cantilever of L/h = 1e4 in statics, of up to 1e5 elements: the condition grows as (N L/h)^2; errors stay "
       "below 10 u times what the run tells as its condition, and none above 1e-3 is passed over in silence",
       long_chain_statics});
  table.push_back({"one_body", "sizes", "a scene of one rigid body falls along its parabola to 1e-12", one_body});
}

}  // namespace bough::stress
