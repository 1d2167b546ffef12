#include "stability_watch.hpp"

#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/schedule/serial.hpp"

namespace bough::run {

StabilityWatch::StabilityWatch(const scene::Scene& scene, step::System& system)
    : scene_(scene), system_(system), stability_(system) {
  seen_.is_declared = scene.analysis.unstable;
  seen_.not_conservative = system.plan().not_conservative;
}

std::string StabilityWatch::describe(const plan::Plan& plan, const step::UnstableMode& mode) {
  std::string axis;
  for (int i = 0; i < 3; ++i) {
    const double part = std::abs(mode.direction[i]) < 5e-3 ? 0.0 : mode.direction[i];  // two digits are shown
    axis += (i == 0 ? "(" : ", ") + io::rounded_text(part, 2);
  }
  return "'" + plan.nodes[static_cast<std::size_t>(mode.node)].name +
         (mode.turns ? "' turns most, about " : "' moves most, along ") + axis + ")";
}

int StabilityWatch::look(const step::State& state, std::optional<step::StabilityLook> known) {
  step::StabilityLook look = known ? *known : stability_.look();
  if (look.is_known && look.unstable > 0 && seen_.unstable_directions == 0) {
    const auto mode = seen_.is_declared ? std::nullopt : stability_.find_mode(state);
    if (mode) seen_.mode = describe(system_.plan(), *mode);
    if (mode || seen_.is_declared) {
      if (!seen_.first_lost) seen_.first_lost = {last_factor_, state.time};
    } else {
      look.unstable = 0;  // the negative pivot is round-off
    }
  }
  seen_.is_known = look.is_known;
  seen_.unstable_directions = look.unstable;
  last_factor_ = state.time;
  return look.unstable;
}

void StabilityWatch::look_at_end(const step::State& state) {
  if (seen_.is_declared) return;
  if (seen_.is_known && seen_.unstable_directions > 0)
    if (const auto mode = stability_.find_mode(state)) seen_.mode = describe(system_.plan(), *mode);
  const plan::Motions motions = system_.plan().unknowns.motions;
  if (motions == plan::Motions::planar || motions == plan::Motions::line) look_at_hidden(state);
}

/// Examines motions that the plan has left out: lateral ones of a line, those out of a plane.
void StabilityWatch::look_at_hidden(const step::State& state) {
  scene::Scene whole = scene_;
  whole.without.insert(whole.without.end(), {"planar", "line"});
  const plan::Plan plan = plan::make_plan(whole);
  const bool is_alike = plan.nodes.size() == state.num_nodes() && plan.joints.size() == state.turns.size() &&
                        static_cast<std::size_t>(plan.num_multipliers) == state.multipliers.size();
  if (!is_alike) return;  // the plan with all motions has other rigid parts
  step::System system(plan, whole.solver, schedule::make_serial_walker());
  step::State at_rest = step::make_spatial(system_.plan(), state);
  at_rest.unsettled.clear();
  if (system.set_time(state.time) || system.evaluate(at_rest, {}, true)) return;
  step::Stability stability(system);
  const bool is_singular = system.linear().factor(true, {}).has_value();
  const step::StabilityLook look = is_singular ? stability.look_closely() : stability.look();
  if (!look.is_known || look.unstable <= seen_.unstable_directions) return;
  const auto mode = stability.find_mode(at_rest);
  if (!mode) return;
  seen_.hidden = system_.plan().unknowns.motions == plan::Motions::line ? "sideways" : "out of its plane";
  seen_.hidden_mode = describe(plan, *mode);
}

}  // namespace bough::run
