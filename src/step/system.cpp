#include "bough/step/system.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bough/step/step_cost.hpp"
#include "drift.hpp"
#include "held_nodes.hpp"

namespace bough::step {

System::System(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker)
    : plan_(plan),
      walker_(walker),
      clock_(walker.threads == 1),
      linear_(plan, solver, walker, clock_, counts_),
      instant_(plan),
      places_(plan, linear_.tree().unknown_begin),
      lengths_(measure_elements(plan)),
      node_order_(std::make_shared<const NodeOrder>(plan, linear_.visits())),
      constraints_(plan, instant_, walker),
      trimmed_(TrimmedElements::are_in(plan) ? std::make_unique<TrimmedElements>(plan) : nullptr),
      held_(plan.held.empty() ? nullptr : std::make_unique<HeldNodes>(plan, *trimmed_)),
      sums_(plan, places_, linear_, trimmed_.get()),
      elements_(plan, instant_, trimmed_.get(), sums_, linear_, walker),
      signals_(plan, instant_, places_, linear_),
      round_off_(plan, places_, linear_, lengths_, walker),
      corrections_(plan, places_, instant_, lengths_, linear_, node_order_, walker, clock_, counts_) {
  work_.rhs.assign(places_.size(), 0.0);
  work_.x = work_.rhs;
  plan.with_group([&]<class G>() {
    auto& choice = work_.drift_choice.emplace<DriftChoice<G>>(make_drift_choice<G>(plan, *node_order_));
    work_.drifted.emplace<DriftedStart<G>>().eights.resize(choice.eights.size());
  });
  linear_.set_renewal_cost(estimate_step_cost(*this).renewal());
}

System::~System() = default;

std::optional<Trouble> System::set_time(double time, laws::Side side) {
  if (auto t = instant_.set(time, side)) return t;
  elements_.take_frames();
  return std::nullopt;
}

void System::remember() {
  constexpr std::size_t most_in_use = 4;
  remembered_.resize(most_in_use + 1);
  linear_.remember();
}

/// In a place that no matrices have which are still in use.
void System::keep_tangents(const State& state, const elements::Slopes& slopes) {
  const auto place = std::find_if(remembered_.begin(), remembered_.end(),
                                  [this](const Tangents& t) { return t.matrices < 0 || !linear_.uses(t.matrices); });
  place->matrices = linear_.num_matrices();
  place->state.take_what_elements_read(state);
  place->slopes = slopes;
  place->time = instant_.time();
  place->side = instant_.side();
  place->take_symmetric_parts = linear_.takes_symmetric_parts();
}

bool System::evaluate_again(const std::vector<Tangents>& known, long matrices) {
  for (const Tangents& t : known) {
    if (t.matrices != matrices) continue;
    if (set_time(t.time, t.side)) return false;
    linear_.take_symmetric_parts(t.take_symmetric_parts);
    begin(t.state, t.slopes, true);
    linear_.visit_all(in_visits());
    sums_.sum_held();
    return true;
  }
  return false;
}

void System::checkpoint(records::Archive& archive, const std::function<bool(long)>& write_others) {
  archive(linear_, round_off_.met());
  std::vector<Tangents> in_use;
  for (const Tangents& t : remembered_)
    if (t.matrices >= 0 && linear_.uses(t.matrices)) in_use.push_back(t);
  archive(in_use);
  if (archive.is_reading()) {
    const std::size_t room = remembered_.size();
    remembered_.clear();  // what is evaluated again is not kept once more
    const auto write = [&](long matrices) { return evaluate_again(in_use, matrices) || write_others(matrices); };
    if (!linear_.make_again(write)) throw std::runtime_error("the matrices of its factorization are not known");
    remembered_ = std::move(in_use);
    remembered_.resize(room);
  }
  archive(counts_);
}

/// Equations of signals read the motion alone, so that they can be evaluated before the visits that need them.
void System::begin(const State& state, const elements::Slopes& slopes, bool tangent) {
  ++counts_.evaluations;
  elements_.begin(state, slopes, tangent);
  if (tangent && remembers()) keep_tangents(state, slopes);
  if (!signals_.are_none()) signals_.evaluate(state, slopes, tangent, sums_);
}

/// Evaluates the elements of a visit and adds up the residuals of its blocks.
solve::VisitWork System::in_visits() {
  return {[](void* context, int visit) {
            auto* const system = static_cast<System*>(context);
            system->elements_.evaluate_visit(visit);
            system->sums_.sum_visit(visit, system->walker_);
          },
          this};
}

void System::make_least(State& state) {
  if (!linear_.has_dependent_rows()) return;
  least_.assign(work_.x.size(), 0.0);
  for (const UnknownPlaces::Multiplier& at : places_.multipliers())
    least_[at.unknown] = state.multipliers[at.multiplier];
  linear_.make_least(least_.data());
  for (const UnknownPlaces::Multiplier& at : places_.multipliers())
    state.multipliers[at.multiplier] = least_[at.unknown];
}

std::optional<Trouble> System::evaluate(const State& state, const elements::Slopes& slopes, bool tangent) {
  PhaseTimer timer{clock_, counts_.assemble};
  begin(state, slopes, tangent);
  linear_.visit_all(in_visits());
  return end(state);
}

std::optional<Trouble> System::evaluate_and_condense(const State& state, const elements::Slopes& slopes) {
  PhaseTimer timer{clock_, counts_.assemble};
  begin(state, slopes, false);
  linear_.condense(in_visits(), right_hand_side().data());
  return end(state);
}

std::optional<Trouble> System::evaluate_and_factor(const State& state, const elements::Slopes& slopes, bool rescale,
                                                   std::optional<Trouble>& of_factor) {
  PhaseTimer timer{clock_, counts_.assemble};
  begin(state, slopes, true);
  const auto found = linear_.factor(rescale, slopes, in_visits(), right_hand_side().data());
  if (auto t = end(state)) return t;
  of_factor = found;
  return std::nullopt;
}

std::optional<Trouble> System::sum(const State& state) {
  auto sum_visit = [this](int visit) { sums_.sum_visit(visit, walker_); };
  linear_.visit_all(solve::make_visit_work(sum_visit));
  return end(state);
}

std::optional<Trouble> System::end(const State& state) {
  sums_.sum_held();
  if (sums_.is_finite()) return std::nullopt;
  const std::string at = " not finite at time " + std::to_string(state.time);
  if (sums_.lost_signal() >= 0)
    return Trouble{"signal '" + plan_.signals[static_cast<std::size_t>(sums_.lost_signal())].name + "' is" + at};
  if (const auto e = sums_.first_not_finite())
    return Trouble{"the forces of '" + plan_.element_owner[*e] + "' are" + at};
  return Trouble{"a sum of forces is" + at};
}

void System::recover_multipliers(State& state, const std::vector<motion::Vec6<double>>* more) const {
  // In statics by the elements in space, as sensors see them: State::unsettled belongs to their residuals.
  if (held_) held_->recover_multipliers(instant_, walker_, state, more);
}

double System::largest_held_impulse(const State& state, const double* x) const {
  return held_ ? held_->largest_impulse(instant_, places_, state, x) : 0.0;
}

}  // namespace bough::step
