#include "stability_watch.hpp"

#include <cmath>

#include "bough/io/number_text.hpp"

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
  if (HiddenMotions::are_in(system_.plan())) {
    hidden_look_ = HiddenMotions(scene_).look(system_.plan(), state, seen_.unstable_directions);
    if (!hidden_look_.mode.empty()) {
      seen_.hidden = HiddenMotions::where(system_.plan());
      seen_.hidden_mode = hidden_look_.mode;
    }
  }
  if (seen_.not_conservative.empty()) return;
  flutter_ = look_for_flutter(scene_, system_.plan(), state);
  seen_.is_known = seen_.unstable_directions > 0 || (flutter_.is_known && flutter_.text.empty());
}

std::string StabilityWatch::not_examined() const {
  if (seen_.is_declared) return {};
  if (!seen_.not_conservative.empty() && seen_.unstable_directions == 0 && !flutter_.is_known)
    return "stability is not examined (" + seen_.not_conservative + "; " + flutter_.why_not + ")";
  if (HiddenMotions::are_in(system_.plan()) && !hidden_look_.is_known)
    return "stability " + HiddenMotions::where(system_.plan()) + " is not examined";
  return seen_.is_known ? "" : "stability is not examined";
}

}  // namespace bough::run
