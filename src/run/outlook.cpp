#include "bough/run/outlook.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "bough/results/balance.hpp"
#include "bough/run/estimate.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/step/state.hpp"
#include "bough/step/step_cost.hpp"
#include "bough/step/system.hpp"
#include "trial_steps.hpp"
#include "twin_scenes.hpp"

namespace bough::run {

namespace {

// Of runs of data/scenarios: in time with and without factors that serve again, and in statics.
constexpr StepWork usual_with_reuse{.iterations = 3.1, .evaluations = 3.5, .factorizations = 0.2, .checks = 0.2},
    usual_without_reuse{.iterations = 3.0, .evaluations = 3.0, .factorizations = 3.0, .checks = 3.0},
    usual_in_statics{.iterations = 4.0, .evaluations = 5.5, .factorizations = 4.0, .checks = 4.0};
// The balances of energy and momentum evaluate elements one by one, in space.
constexpr double per_balance = 1.37;
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

/// Seconds of a step with this work per step, by the model.
double set_seconds(Effort& e, const step::StepCost& cost, const StepWork& work) {
  e.iterations = work.iterations;
  e.evaluations = work.evaluations;
  e.factorizations = work.factorizations;
  e.trial_steps = work.trial_steps;
  e.evaluate_seconds =
      std::max(0.0, work.evaluations - work.factorizations) * cost.residual + work.factorizations * cost.tangent;
  e.factor_seconds = work.factorizations * cost.factor;
  e.solve_seconds = work.iterations * cost.solve + work.checks * cost.check;
  e.other_seconds = work.iterations * cost.update + cost.end;
  return e.step_seconds();
}

/// Trial steps. Short ones in time are taken three times, and the least time counts: something else may have disturbed
/// one of them. Statics has few steps, and what it touches for the first time is a part of their time.
std::optional<StepWork> try_quietly(const scene::Scene& scene, int steps, bool is_dynamic) {
  constexpr double is_long = 0.05;  // [s]
  std::optional<StepWork> work = try_steps(scene, steps);
  for (int again = 0; again < 2 && is_dynamic && work && work->seconds * steps < is_long; ++again)
    if (const auto other = try_steps(scene, steps)) work->seconds = std::min(work->seconds, other->seconds);
  return work;
}

/// The work of a step: that of trial steps, as many as the model allows, or the usual one.
StepWork work_of(const scene::Scene& scene, const Built& b) {
  constexpr double allowed = 0.2, longest = 1.0;  // of all trial steps, and of the fewest [s]
  const int most = 2048, fewest = b.plan.is_dynamic ? 8 : 1;
  const StepWork& usual = !b.plan.is_dynamic     ? usual_in_statics
                          : b.plan.took("reuse") ? usual_with_reuse
                                                 : usual_without_reuse;
  Effort e;
  const double step = set_seconds(e, step::estimate_step_cost(b.system), usual);
  if (fewest * step > longest) return usual;
  const double steps =
      std::clamp(allowed / step, 1.0 * fewest, std::max(1.0 * fewest, 0.5 * estimate_run(scene).steps));
  return try_quietly(scene, static_cast<int>(std::min(steps, 1.0 * most)), b.plan.is_dynamic).value_or(usual);
}

/// What a step of this work costs by the model.
Effort effort_of(const scene::Scene& scene, Built& b, const StepWork& work) {
  Effort e;
  e.unknowns = b.system.linear().tree().num_unknowns();
  const step::StepCost cost = step::estimate_step_cost(b.system);
  set_seconds(e, cost, work);
  if (scene.output.checks) e.other_seconds += per_balance * results::WorkMeter(b.plan).evaluation_cost();
  e.model_seconds = e.step_seconds();
  const solve::SolverCounters counters = b.system.linear().solver().counters();
  e.factor_flops = counters.factor_flops;
  e.memory_bytes = counters.memory_bytes;
  e.memory_bytes += bytes_of(b.system);
  return e;
}

/// Measured over modelled time of a step; 1 where it was not measured.
double measured_ratio(const StepWork& work, const Effort& modelled) {
  return work.seconds > 0.0 ? work.seconds / modelled.model_seconds : 1.0;
}
void scale_seconds(Effort& e, double ratio) {
  for (double* part : {&e.evaluate_seconds, &e.factor_seconds, &e.solve_seconds, &e.other_seconds}) *part *= ratio;
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

std::vector<OutlookTwin> twins_of(const scene::Scene& scene, const Outlook& out) {
  std::vector<OutlookTwin> list;
  const double own = estimate_run(scene).scene_bytes();
  for (const Twin& t : make_twins(scene).members)
    list.push_back({text_of(t), t.cost * out.steps * out.effort.step_seconds(),
                    static_cast<double>(out.effort.memory_bytes) * estimate_run(t.scene).scene_bytes() / own});
  return list;
}

}  // namespace

double forecast_seconds(const scene::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  Built built(scene);
  const double prepare = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const StepWork work = work_of(scene, built);
  Effort e = effort_of(scene, built, work);
  scale_seconds(e, measured_ratio(work, e));
  return prepare + estimate_run(scene).steps * e.step_seconds();
}

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
  const StepWork work = work_of(scene, built);
  out.effort = effort_of(scene, built, work);
  const double measured = measured_ratio(work, out.effort);
  scale_seconds(out.effort, measured);
  const solve::SolverCounters counters = built.system.linear().solver().counters();
  out.fronts_in_lanes = static_cast<int>(counters.fronts_in_lanes);
  out.steps = estimate_run(scene).steps;
  out.process_bytes = program_bytes + out.effort.memory_bytes;
  out.twins = twins_of(scene, out);
  for (const OutlookTwin& t : out.twins) out.process_bytes += static_cast<std::int64_t>(t.memory_bytes);
  out.mobility = plan.mobility;
  out.notes = plan.notes;
  if (scene.analysis.accuracy)
    out.notes.emplace_back(
        "steps and meshes that meet the accuracy are found by trials: what is told here is that of the first one, "
        "without its twins");
  for (const plan::Decision& d : plan.decisions) {
    OutlookDecision o{d, d.taken && d.can_be_barred, {}};
    if (o.has_saving) {
      scene::Scene other = scene;
      other.without.push_back(d.name);
      Built without(other);
      const bool iterates_alike = d.name != "reuse" && d.name != "symmetric";
      const StepWork other_work = iterates_alike ? work : work_of(other, without);
      o.without = effort_of(other, without, other_work);
      scale_seconds(o.without, iterates_alike ? measured : measured_ratio(other_work, o.without));
    }
    out.decisions.push_back(o);
  }
  return out;
}

}  // namespace bough::run
