#include "other_motions.hpp"

#include "bough/io/number_text.hpp"
#include "bough/scene/problems.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/step/flutter.hpp"
#include "stability_watch.hpp"

namespace bough::run {

namespace {

bool is_alike(const plan::Plan& plan, const step::State& state) {
  return plan.nodes.size() == state.num_nodes() && plan.joints.size() == state.turns.size() &&
         static_cast<std::size_t>(plan.num_multipliers) == state.multipliers.size();
}

scene::Scene in_all_motions(const scene::Scene& scene) {
  scene::Scene whole = scene;
  whole.without.insert(whole.without.end(), {"planar", "line", "translation"});
  return whole;
}

/// Counts unstable directions at a state whose time is set. `stability` reads the tangents made here.
step::StabilityLook count(step::System& system, step::Stability& stability, const step::State& state) {
  if (system.evaluate(state, {}, true)) return {};
  const bool is_singular = system.linear().factor(true, {}).has_value();
  return is_singular ? stability.look_closely() : stability.look();
}

}  // namespace

bool HiddenMotions::are_in(const plan::Plan& plan) {
  return plan.unknowns.motions == plan::Motions::planar || plan.unknowns.motions == plan::Motions::line;
}

std::string HiddenMotions::where(const plan::Plan& plan) {
  return plan.unknowns.motions == plan::Motions::line ? "sideways" : "out of its plane";
}

std::optional<int> HiddenMotions::count_own(const plan::Plan& plan, const step::State& state) {
  if (!own_) own_ = std::make_unique<step::System>(plan, scene_.solver, schedule::make_serial_walker());
  if (own_->set_time(state.time)) return std::nullopt;
  step::Stability stability(*own_);
  const step::StabilityLook look = count(*own_, stability, state);
  if (!look.is_known) return std::nullopt;
  return look.unstable > 0 && stability.find_mode(state) ? look.unstable : 0;
}

HiddenMotions::Look HiddenMotions::look(const plan::Plan& plan, const step::State& state, std::optional<int> unstable) {
  if (!whole_) {
    whole_ = std::make_unique<Model>(Model{plan::make_plan(in_all_motions(scene_)), nullptr});
    if (whole_->plan.is_on<motion::Se3>() && is_alike(whole_->plan, state))
      whole_->system = std::make_unique<step::System>(whole_->plan, scene_.solver, schedule::make_serial_walker());
  }
  if (!whole_->system) return {};  // the plan with all motions has other rigid parts
  step::System& system = *whole_->system;
  step::State there = step::make_spatial(plan, state);
  there.unsettled.clear();
  if (system.set_time(state.time)) return {};
  step::Stability stability(system);
  const step::StabilityLook look = count(system, stability, there);
  if (!look.is_known) return {};
  if (look.unstable == 0) return {true, ""};
  if (!unstable) unstable = count_own(plan, state);
  if (!unstable) return {};
  if (look.unstable <= *unstable) return {true, ""};
  const auto mode = stability.find_mode(there);
  return {true, mode ? StabilityWatch::describe(whole_->plan, *mode) : ""};
}

FlutterLook look_for_flutter(const scene::Scene& scene, const plan::Plan& plan, const step::State& state) {
  scene::Scene moving = in_all_motions(scene);
  moving.analysis = {};
  moving.analysis.end_time = 1.0;
  moving.analysis.frame = scene.analysis.frame;
  moving.expected.clear();
  moving.measures.clear();
  const char* const none = "the vibrations about the equilibrium are not examined: ";
  if (!plan.frames.empty()) return {false, "", std::string(none) + "it is described in a moving frame"};
  if (state.time != 1.0) return {false, "", std::string(none) + "the load factor is not 1"};
  if (!scene::problems_in(moving).empty()) return {false, "", std::string(none) + "there are parts without mass"};
  const plan::Plan whole = plan::make_plan(moving);
  if (!whole.is_on<motion::Se3>() || !is_alike(whole, state))
    return {false, "", std::string(none) + "dynamics have other rigid parts"};
  step::System system(whole, moving.solver, schedule::make_serial_walker());
  step::State there = step::make_spatial(plan, state);
  there.unsettled.clear();
  step::set_at_rest(there);
  if (system.set_time(1.0)) return {false, "", std::string(none) + "loads are not finite"};
  const std::optional<step::Flutter> found = step::find_flutter(system, there);
  if (!found) return {false, "", std::string(none) + "there is no mass, or the equilibrium is not unique"};
  if (!found->is_there) return {true, "", ""};
  const std::string node = "'" + whole.nodes[static_cast<std::size_t>(found->node)].name + "'";
  if (found->frequency == 0.0)
    return {true,
            "the last equilibrium is unstable: it is left, most by " + node + ", e times as far every " +
                io::rounded_text(1.0 / found->growth, 2) + " s",
            ""};
  return {true,
          "the last equilibrium is unstable: it flutters, vibrations of " + io::rounded_text(found->frequency, 3) +
              " rad/s grow, most those of " + node + ", by e every " + io::rounded_text(1.0 / found->growth, 2) +
              " s (dampers left out)",
          ""};
}

}  // namespace bough::run
