#include "bough/run/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bough/plan/plan.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/problems.hpp"
#include "twin_scenes.hpp"

namespace bough::run {

namespace {

// Fitted by hand to the resident memory of runs in space: one beam of 20000 elements of order 1 (370 MB) and 3 (519
// MB), 5000 bodies on revolute joints (206 MB), lattices of 40 x 40 and 80 x 80 nodes (54 and 179 MB). Runs in a plane
// take 0.45 to 0.6 of these.
constexpr double of_node = 10e3, of_inner_node = 5e3, of_element = 7.5e3, of_joint = 28e3, of_spring = 6e3,
                 of_loop = 700.0;
constexpr double line_part = 0.4;      ///< memory of motion on a line, relative to motion in space
constexpr double planar_part = 0.6;    ///< the same for motion in a plane
constexpr double of_unknown = 0.2e-6;  ///< time per step and unknown [s], as `bough plan` gives for a chain
/// Nodes, elements and joints of the largest scene whose plan is made to learn how it moves: 1.5 kB and 9 us each.
constexpr double most_planned = 2e5;

double part_of(plan::Motions motions) {
  return motions == plan::Motions::spatial ? 1.0 : motions == plan::Motions::line ? line_part : planar_part;
}

double num_parts(const Estimate& e) { return e.nodes + e.elements + e.joints; }

/// The motions that a scene can make, by its plan; none: that would take too long. Into how many elements beams are
/// divided does not matter for that, so that the plan of a large scene is made with two each, unless something else of
/// the scene names the nodes between them.
std::optional<plan::Motions> motions_of(const scene::Scene& scene, const Estimate& e) {
  constexpr int enough = 2;
  if (num_parts(e) <= most_planned) return plan::make_plan(scene).unknowns.motions;
  scene::Scene coarse = scene;
  for (scene::Beam& b : coarse.beams) b.elements = std::min(b.elements, enough);
  if (num_parts(estimate_run(coarse)) > most_planned) return std::nullopt;
  const auto problems = scene::problems_in(coarse);
  if (!std::all_of(problems.begin(), problems.end(), [](const auto& p) { return p.is_warning; })) return std::nullopt;
  return plan::make_plan(coarse).unknowns.motions;
}

std::string rounded(double x) {
  const double scale = std::pow(10.0, std::max(0.0, std::floor(std::log10(std::max(x, 1.0))) - 1.0));
  return std::to_string(static_cast<long long>(std::min(9e18, scale * std::round(x / scale))));
}
std::string megabytes(double bytes) { return rounded(1e-6 * bytes) + " MB"; }

double steps_of(const scene::Analysis& a) {
  if (scene::type_of(a.kind).is_of_instant) return 1.0;
  if (scene::type_of(a.kind).is_in_time)
    return a.step_size > 0.0 ? std::ceil(a.end_time / a.step_size * (1.0 - 1e-9)) : 0.0;
  return a.arc_length ? a.arc_length->max_steps : a.load_steps;
}

}  // namespace

Estimate estimate_run(const scene::Scene& scene) {
  Estimate e;
  double inner = 0.0;
  for (const scene::Beam& b : scene.beams) {
    const double elements = b.elements;
    e.elements += elements;
    e.nodes += elements - 1.0;
    inner += elements * (b.order - 1.0);
  }
  const double ends = static_cast<double>(scene.nodes.size() + scene.bodies.size());
  const auto links = static_cast<double>(scene.couplings.size());
  const double loads = static_cast<double>(scene.point_loads.size() + scene.line_loads.size());
  e.nodes += ends + inner;
  e.joints = static_cast<double>(scene.joints.size() + scene.motions.size());
  e.unknowns = 6.0 * e.nodes;
  for (const scene::Joint& j : scene.joints)
    e.unknowns += static_cast<double>(scene::type_of(j.kind).rows.size() + j.drives.size());
  const double loops = std::max(0.0, static_cast<double>(scene.beams.size()) + e.joints + links - ends);
  e.memory_bytes = Estimate::program_bytes + of_node * (e.nodes - inner) + of_inner_node * inner +
                   of_element * e.elements + of_joint * e.joints + of_spring * (links + loads) +
                   of_loop * loops * std::log2(loops + 1.0);
  e.elements += static_cast<double>(scene.bodies.size()) + links + loads;
  e.steps = steps_of(scene.analysis);
  e.step_seconds = of_unknown * e.unknowns;
  return e;
}

std::string refusal(const scene::Scene& scene, double limit) {
  const Estimate e = estimate_run(scene);
  double bytes = e.memory_bytes;
  std::string beside;
  if (bytes <= limit && scene.analysis.errors.any()) {
    for (const Twin& t : make_twins(scene).members) bytes += estimate_run(t.scene).scene_bytes();
    beside = " with the twins that measure its errors";
  }
  if (bytes <= limit) return "";
  std::string taken_as = "";
  if (line_part * bytes <= limit) {
    const std::optional<plan::Motions> motions = motions_of(scene, e);
    if (motions) bytes *= part_of(*motions);
    if (bytes <= limit) return "";
    if (!motions) taken_as = ", of a motion in space, for which so large a scene is taken";
  }
  return "a run" + beside + " would take about " + megabytes(bytes) + " of memory" + taken_as + ", and " +
         megabytes(limit) + " are there: " + rounded(e.nodes) + " nodes, " + rounded(e.elements) + " elements, " +
         rounded(e.unknowns) + " unknowns in space, " + rounded(e.steps) + " steps of about " +
         rounded(1e3 * e.step_seconds) + " ms on one thread; take fewer elements, or allow more with --memory-limit";
}

}  // namespace bough::run
