#include "bough/run/outlook.hpp"

#include <algorithm>
#include <memory>

#include "bough/run/estimate.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/step/state.hpp"
#include "bough/step/step_cost.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

namespace {

constexpr double usual_iterations = 3.1, usual_evaluations = 3.4, usual_factorizations = 0.46;
constexpr std::int64_t program_bytes = 11'000'000;  ///< resident memory of the program before a scene is built

std::int64_t bytes_of(const step::System& system) {
  const plan::Plan& plan = system.plan();
  std::int64_t elements = 0, element_unknowns = 0;
  plan::for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    elements += static_cast<std::int64_t>(array.size() * sizeof(E));
    element_unknowns += static_cast<std::int64_t>(array.size()) * (6 * E::num_ports);
  });
  const auto nodes = static_cast<std::int64_t>(plan.nodes.size());
  constexpr std::int64_t of_state =
      sizeof(elements::NodeMotion) + sizeof(motion::Quaternion<double>) + 2 * sizeof(motion::Vec6<double>);
  constexpr std::int64_t states = 5, per_node_plan = 2600;  // plan, names, lists, the scene
  return elements * 2 + element_unknowns * 3 * 8 + nodes * (states * of_state + per_node_plan) +
         static_cast<std::int64_t>(system.places().size()) * 6 * 8;
}

struct Built {
  plan::Plan plan;
  step::System system;
  explicit Built(const scene::Scene& scene)
      : plan(plan::make_plan(scene)), system(plan, scene.solver, schedule::make_serial_walker()) {}
};

Effort effort_of(Built& b) {
  Effort e;
  const bool reuse = b.plan.took("reuse"), dynamic = b.plan.is_dynamic;
  e.unknowns = b.system.linear().tree().num_unknowns();
  e.iterations = reuse ? usual_iterations : dynamic ? 3.0 : 5.0;
  e.factorizations = reuse ? usual_factorizations : e.iterations;
  const double residuals = reuse ? usual_evaluations : 1.0, tangents = e.factorizations;
  const step::StepCost cost = step::estimate_step_cost(b.system);
  e.evaluate_seconds = residuals * cost.residual + tangents * cost.tangent;
  e.factor_seconds = e.factorizations * cost.factor;
  e.solve_seconds = e.iterations * cost.solve;
  e.other_seconds = e.iterations * cost.update;
  const solve::SolverCounters counters = b.system.linear().solver().counters();
  e.factor_flops = counters.factor_flops;
  e.memory_bytes = counters.memory_bytes;
  e.memory_bytes += bytes_of(b.system);
  return e;
}

const char* words(plan::Motions motions) {
  switch (motions) {
    case plan::Motions::planar:
      return "in a plane";
    case plan::Motions::translation:
      return "without rotation";
    case plan::Motions::line:
      return "on a line";
    case plan::Motions::spatial:
      break;
  }
  return "in space";
}

}  // namespace

Outlook look_ahead(const scene::Scene& scene) {
  Outlook out;
  out.scene = scene.name;
  out.title = scene.title;
  Built built(scene);
  const plan::Plan& plan = built.plan;
  out.nodes = plan.nodes.size();
  out.elements = plan.directory.size();
  out.joints = plan.joints.size();
  out.unknowns_in_space = 6 * static_cast<std::int64_t>(out.nodes) + plan.num_multipliers;
  out.motions = words(plan.unknowns.motions);
  const tree::Tree& tree = built.system.linear().tree();
  out.cut = tree.method;
  out.sub_domains = tree.num_subdomains();
  out.fronts = tree.num_fronts();
  for (const tree::Subdomain& s : tree.subdomains) {
    out.leaves += s.is_leaf() ? 1 : 0;
    out.levels = std::max(out.levels, s.level + 1);
  }
  out.effort = effort_of(built);
  const solve::SolverCounters counters = built.system.linear().solver().counters();
  out.fronts_in_lanes = static_cast<int>(counters.fronts_in_lanes);
  out.steps = estimate_run(scene).steps;
  out.process_bytes = program_bytes + out.effort.memory_bytes;
  out.mobility = plan.mobility;
  out.notes = plan.notes;
  for (const plan::Decision& d : plan.decisions) {
    OutlookDecision o{d, d.taken && d.can_be_barred, {}};
    if (o.has_saving) {
      scene::Scene other = scene;
      other.without.push_back(d.name);
      Built without(other);
      o.without = effort_of(without);
    }
    out.decisions.push_back(o);
  }
  return out;
}

}  // namespace bough::run
