#include "about_state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bough/io/number_text.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "mode_steadiness.hpp"
#include "turning_start.hpp"

namespace bough::run {

namespace {

using step::Linearisation;
using Part = Linearisation::Part;

constexpr double symmetric_to_round_off = 1e-9;  ///< relative difference from a symmetric matrix that is round-off
constexpr double still = 1e-6;  ///< inertia forces over the largest force above which a state is no equilibrium
constexpr double stiff_round_off = 1e-12;  ///< of accelerations, over the largest squared frequency and the size

}  // namespace

AboutState::AboutState(const scene::Scene& scene, step::System& system, step::State& state,
                       const step::StepOptions& options)
    : scene_(scene), plan_(system.plan()), system_(system), state_(state), options_(options) {}

std::string AboutState::find() {
  if (const auto trouble = system_.set_time(0.0, laws::Side::right)) return trouble->text;
  const bool wants_equilibrium = scene_.analysis.start == scene::StartKind::equilibrium;
  if (wants_equilibrium)
    if (std::string cause = find_equilibrium(); !cause.empty()) return cause;
  // At rest the equilibrium is consistent: drives are held, whatever their laws do next.
  if (!wants_equilibrium || !is_at_rest()) {
    const step::StartReport report =
        step::make_consistent_on(system_, state_, true, scene_.analysis.step_size, laws::Side::right);
    moved_ = std::max(moved_, report.position_correction);
    if (!report.ok) return report.cause;
  }
  if (moved_ > 1e-9)
    notes_.push_back("the start was moved by up to " + io::rounded_text(moved_, 3) + " (relative) to close the joints");
  return {};
}

std::string AboutState::find_equilibrium() {
  const std::optional<scene::Spin> spin = spin_at_start(scene_, plan_);
  const step::EquilibriumReport rest =
      spin ? find_turning_equilibrium(scene_, plan_, *spin, options_, state_)
           : step::find_equilibrium(system_, state_, options_, scene_.analysis.step_size);
  iterations_ += rest.iterations;
  if (!rest.found)
    return "there is no equilibrium to be about: " + rest.cause +
           "; \"about\": \"start\" takes the state as the scene gives it";
  notes_.push_back("the state is the equilibrium under the loads of time 0, which is up to " +
                   io::rounded_text(rest.moved, 3) +
                   " of the size of the structure, or rad, from the places of the scene");
  return {};
}

bool AboutState::is_at_rest() const {
  const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan_, state_);
  return std::all_of(nodes.begin(), nodes.end(), [](const auto& n) { return lanes::dot(n.v, n.v) == 0.0; });
}

std::string AboutState::linearise(Linearisation& linear) {
  if (const auto trouble = linear.take(state_)) return trouble->text;
  look_at_balance(linear);
  if (is_at_rest()) return {};
  const Steadiness steady = look_at_steadiness(system_, linear, state_);
  if (steady.from_ground)
    linear.describe_from_ground(state_);
  else
    linear.describe_from_parts(state_);
  is_from_ground_ = steady.from_ground;
  moves_ = true;
  unsteady_ = steady.doubt;
  return {};
}

/// In an equilibrium or a steady motion the components of velocities in own axes do not change.
void AboutState::look_at_balance(const Linearisation& linear) {
  std::vector<double> a(linear.size(), 0.0), force(linear.size());
  const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan_, state_);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    system_.places().set_node_part(a.data(), static_cast<int>(n), nodes[n].a);
  linear.multiply(Part::mass, a, force);
  if (system_.evaluate(state_, {}, false)) return;
  const step::ResidualSize size = system_.residual_size();
  const double scale = std::max(size.force_scale, size.moment_scale / plan_.length_scale);
  double most = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (const double w = linear.weights()[i]; w > 0.0)
      most = std::max(most, std::abs(force[i]) * (w == 1.0 ? 1.0 / plan_.length_scale : 1.0));
  const int node = linear.largest_node(a);
  if (!(most > still * scale) || node < 0) return;
  const motion::Vec6<double>& fastest = nodes[static_cast<std::size_t>(node)].a;
  const double acceleration = length_of(lanes::linear_part(fastest));
  // Of what round-off of positions makes in the stiffest parts nothing is told.
  if (acceleration + plan_.length_scale * length_of(lanes::angular_part(fastest)) <
      stiff_round_off * linear.fastest() * plan_.length_scale)
    return;
  imbalance_ = "the state is no equilibrium and no steady motion: '" +
               plan_.nodes[static_cast<std::size_t>(node)].name + "' accelerates, by " +
               io::rounded_text(acceleration, 3) + " m/s^2, and " + io::rounded_text(100.0 * most / scale, 2) +
               " % of the largest force is inertia; the results are those of the equations as they stand at this "
               "instant, and \"about\": \"equilibrium\" has them about the state of rest";
}

step::ModesFound AboutState::find_modes(Linearisation& linear, const scene::ModesAsked& asked) {
  bool has_damping = linear.largest(Part::damping) > 0.0;
  if (has_damping && !asked.damping) {
    const double before = linear.largest(Part::damping);
    linear.leave_out_dampers();
    has_damping = linear.largest(Part::damping) > 1e-12 * before;
    if (linear.largest(Part::damping) < (1.0 - 1e-9) * before)
      notes_.emplace_back("dampers are left out; \"damping\": true in /analysis has them count");
  }
  const bool is_conservative =
      plan_.not_conservative.empty() || linear.asymmetry(Part::stiffness) < symmetric_to_round_off;
  const step::ModesWanted wanted{asked.count, 2.0 * std::numbers::pi * asked.shift};
  if (is_conservative && plan_.num_driving_signals == 0) linear.take_symmetric_part(Part::stiffness);
  return is_conservative && !has_damping && plan_.num_driving_signals == 0 ? step::find_undamped_modes(linear, wanted)
                                                                           : step::find_complex_modes(linear, wanted);
}

std::string AboutState::text() const {
  return std::string(scene_.analysis.start == scene::StartKind::equilibrium
                         ? "the equilibrium under the loads of time 0"
                         : "the state at time 0") +
         (plan_.observer >= 0 ? ", seen from the frame '" + scene_.analysis.frame + "'" : "") +
         (!moves_           ? ""
          : is_from_ground_ ? ", which turns: frequencies are those seen from the ground"
                            : ", which turns: frequencies are those seen from the parts that turn");
}

std::vector<std::string> AboutState::doubts() const {
  std::vector<std::string> list;
  for (const std::string& text : {imbalance_, unsteady_})
    if (!text.empty()) list.push_back(text);
  return list;
}

}  // namespace bough::run
