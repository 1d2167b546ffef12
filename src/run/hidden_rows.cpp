#include "hidden_rows.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "bough/schedule/serial.hpp"
#include "dependent_rows.hpp"

namespace bough::run {

namespace {

/// Whether rows of the scene's joints are no unknowns of the plan.
bool omits_rows(const plan::Plan& plan) {
  if (!plan.welds.empty()) return true;
  return std::any_of(plan.joints.begin(), plan.joints.end(), [&plan](const plan::JointPlan& j) {
    bool omits = false;
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(j.element)], [&](const auto& e) {
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint)
        omits = j.rows.size() < static_cast<std::size_t>(e.num_rows);
    });
    return omits;
  });
}

/// Whether joints and prescribed motions close a loop, the ground being one part.
bool has_loop(const scene::Scene& scene) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  std::vector<std::size_t> parent;
  const auto root = [&](std::string_view part) {
    const auto [known, is_new] = index_of.emplace(part, parent.size());
    if (is_new) parent.push_back(parent.size());
    std::size_t i = known->second;
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  bool closes = false;
  const auto join = [&](std::string_view first, std::string_view second) {
    const std::size_t a = root(first), b = root(second);
    closes |= a == b;
    parent[b] = a;
  };
  for (const scene::Joint& j : scene.joints) join(j.first.to, j.second.to);
  for (const scene::PrescribedMotion& m : scene.motions) join("", m.at.to);
  return closes;
}

}  // namespace

std::optional<RowsInSpace> find_rows_in_space(const scene::Scene& scene, const step::System& system,
                                              const step::State& state) {
  if (!omits_rows(system.plan()) || !has_loop(scene)) return std::nullopt;
  scene::Scene whole = scene;
  whole.sensors.clear();
  whole.solver = {};
  whole.without.insert(whole.without.end(), {"planar", "line", "translation", "held", "welded"});
  plan::Plan plan = plan::make_plan(whole);
  plan.precision = system.plan().precision;  // in which the scene is planar, and its rows depend
  step::System in_space(plan, whole.solver, schedule::make_serial_walker());
  const bool is_alike = plan.nodes.size() == state.num_nodes() && plan.joints.size() == state.turns.size() &&
                        static_cast<std::size_t>(plan.num_multipliers) == state.multipliers.size();
  step::State examined = is_alike ? step::make_spatial(system.plan(), state) : step::make_initial_state(plan);
  examined.unsettled.clear();
  elements::Slopes slopes;  // those of a step, so that rows are judged as in one
  if (plan.is_dynamic) {
    const double h = scene.analysis.step_size;
    slopes = {2.0 / h, 4.0 / (h * h), false, 2.0 / h};
  }
  if (in_space.set_time(examined.time) || in_space.evaluate(examined, slopes, true)) return std::nullopt;
  if (in_space.linear().factor(true, slopes)) return std::nullopt;  // the structure is singular: told elsewhere
  const auto& solver = in_space.linear().solver();
  const int dependent = solver.last_status().deficiency;
  if (dependent < 0) return std::nullopt;
  return RowsInSpace{dependent, dependent_groups_text(in_space, solver.blocks_not_unique())};
}

}  // namespace bough::run
