/// Critical load factors of a loaded structure, each about the shape that it has under its load.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "analysis.hpp"
#include "bough/io/number_text.hpp"
#include "bough/step/critical_loads.hpp"
#include "bough/step/modes.hpp"
#include "bough/step/stability.hpp"
#include "mode_pictures.hpp"
#include "not_judged.hpp"
#include "stability_watch.hpp"

namespace bough::run {

namespace {

using step::Linearisation;

constexpr double settled_factor = 1e-9;  ///< relative change of a critical factor between two estimates
constexpr double near_enough = 1e-3;     ///< distance of the state from it, over it, at the last estimate
constexpr double one_load = 1e-5;        ///< relative distance of factors that are one
constexpr double small_part = 3e-3;  ///< of a factor, of a difference of tangents: round-off is left of smaller ones
constexpr double part_of_way = 0.9;  ///< of the way to the estimate that a load step takes
constexpr int most_estimates = 500, most_halvings = 16;

/// Follows equilibria from the unloaded one. At a load factor f0 it solves  (K + (f - f0) K') x = 0,  with K' by a
/// difference of tangents at two equilibria, takes a part of the way to the nearest factor f above, and repeats this
/// until f is known: its error shrinks with the square of the way that is left. One critical factor, or several equal
/// ones, is a step.
class Buckling final : public Analysis {
 public:
  explicit Buckling(const Parts& parts) : Analysis(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<Buckling>(*this); }
  bool begin() override;
  bool take_step() override;
  bool is_done() const override { return is_done_; }
  bool ends_in_correction() const override { return false; }
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(is_done_, is_counted_, last_critical_, way_, found_);
  }
  void sum_up() override;
  void add_doubts() override {
    if (!missed_.empty()) summary().doubts.push_back({"buckling", missed_});
  }
  std::string not_judged() const override {
    return one_line({plan_.beams.empty() ? "" : the_mesh,
                     is_symmetric() ? "" : "flutter under loads without a potential is not looked for",
                     "imperfections and other branches are not looked at"});
  }

 private:
  struct Found {
    double factor = 0.0;
    double change = 0.0;  ///< from the estimate before, relative
    step::CriticalLoad load;
    step::UnstableMode where;
    void checkpoint(records::Archive& archive) { archive(factor, change, load.distance, load.shape, where); }
  };
  struct Estimate {
    bool is_reached = true;  ///< the equilibria beside the present one were found
    std::string cause;       ///< why there is no estimate; empty: there is
    step::CriticalLoads loads;
    std::vector<step::CriticalLoad> next;  ///< the nearest above what has been found, and its equals
  };

  bool is_symmetric() const { return plan_.not_conservative.empty(); }
  std::optional<std::string> go_to(step::State& state, double factor);
  std::string take_tangents(Linearisation& to, step::State& at);
  Estimate estimate(double difference);
  Estimate first_estimate();
  std::string leave_behind();
  std::optional<std::string> approach(double factor, double part);
  bool find_next(std::vector<Found>& found, bool& is_last);

  bool is_done_ = false;
  bool is_counted_ = true;  ///< the inertia of every tangent had as many negative directions as were passed
  double last_critical_ = 0.0;
  double way_ = 1.0;  ///< of load factors, the order of the next critical one
  std::vector<Found> found_;
  std::string missed_;
};

/// To the equilibrium at a load factor, in as many steps as it takes. Returns why there is none.
std::optional<std::string> Buckling::go_to(step::State& state, double factor) {
  int halvings = 0;
  double step = factor - state.time;
  while (state.time != factor) {
    const double target = std::abs(factor - state.time) <= 1.001 * std::abs(step) ? factor : state.time + step;
    const step::StepReport report = step::equilibrate(system_, state, options_, target);
    account().newton_iterations() += report.iterations;
    if (!report.converged) {
      if (++halvings > most_halvings)
        return "no equilibrium at load factor " + io::rounded_text(target, 9) + ": " + report.cause;
      step *= 0.5;
      continue;
    }
    if (!plan_.joints.empty()) step::accept_turns(system_, state);
  }
  return std::nullopt;
}

std::string Buckling::take_tangents(Linearisation& to, step::State& at) {
  if (const auto trouble = system_.set_time(at.time)) return trouble->text;
  const bool took_symmetric_parts = system_.linear().takes_symmetric_parts();
  system_.linear().take_symmetric_parts(false);
  const auto trouble = system_.evaluate(at, {}, true);
  to.take_tangents();
  system_.linear().take_symmetric_parts(took_symmetric_parts);
  system_.linear().forget_factor();
  return trouble ? trouble->text : "";
}

/// At the present state, with K' by the tangents there and at two equilibria whose load factors differ by `difference`
/// and by twice as much:  K' = (4 (K_1 - K) - (K_2 - K)) / (2 difference),  of second order.
Buckling::Estimate Buckling::estimate(double difference) {
  Estimate result;
  Linearisation here(system_);
  std::array<Linearisation, 2> there{Linearisation(system_), Linearisation(system_)};
  step::State other = state_;
  for (std::size_t k = 0; k < there.size() && result.cause.empty(); ++k) {
    const auto why = go_to(other, state_.time + (1.0 + static_cast<double>(k)) * difference);
    result.is_reached = !why;
    result.cause = why ? *why : take_tangents(there[k], other);
  }
  if (result.cause.empty()) result.cause = take_tangents(here, state_);
  if (!result.cause.empty()) return result;
  here.add_difference(Linearisation::Part::mass, 2.0 / difference, there[0]);  // -K'
  here.add_difference(Linearisation::Part::mass, -0.5 / difference, there[1]);
  result.loads = step::find_critical_loads(here, is_symmetric(), scene_.analysis.buckling.count + 2);
  result.cause = result.loads.cause;
  // Those behind are known, or are none: K + d K' of a shape that bends is singular far away, too, where K'' counts. Only
  // those come nearer as the load grows that are critical.
  const double least = is_symmetric() ? 0.0 : -0.02 * (state_.time - last_critical_);
  for (const step::CriticalLoad& load : result.loads.loads)
    if (load.distance > least) result.next.push_back(load);
  std::stable_sort(result.next.begin(), result.next.end(),
                   [](const auto& a, const auto& b) { return a.distance < b.distance; });
  const auto is_other = [&](const step::CriticalLoad& load) {
    return load.distance - result.next.front().distance > one_load * std::abs(state_.time + load.distance);
  };
  result.next.erase(std::find_if(result.next.begin(), result.next.end(), is_other), result.next.end());
  return result;
}

/// Of which order critical factors are is not known at the start, and a difference of tangents has to be a small part
/// of them, but not so small that round-off is left of it.
Buckling::Estimate Buckling::first_estimate() {
  constexpr double small = 1e-2;
  constexpr int tries = 24;
  Estimate result;
  for (int k = 0; k < tries; ++k) {
    const double difference = small * way_;
    result = estimate(difference);
    if (!result.cause.empty()) {
      if (result.is_reached) return result;
      way_ *= 0.1;
      continue;
    }
    if (result.next.empty()) return result;
    const double factor = state_.time + result.next.front().distance;
    if (factor > 0.2 * way_ && factor < 5.0 * way_) return result;
    way_ = factor;
  }
  return result;
}

bool Buckling::begin() {
  if (const auto trouble = system_.set_time(0.0)) return fail(trouble->text);
  const step::StepReport start = step::equilibrate(system_, state_, options_, 0.0);
  if (!start.converged) return fail("no equilibrium without loads: " + start.cause);
  record(0, true);  // pictures that follow are those of shapes
  return true;
}

/// Beyond the last critical factors, where the tangent is not nearly singular and no further one has been passed.
std::string Buckling::leave_behind() {
  double beyond = 0.02;
  std::string why;
  for (int k = 0; k < 8; ++k, beyond *= 0.25) {
    step::State next = state_;
    if (const auto cause = go_to(next, (1.0 + beyond) * last_critical_)) {
      why = *cause;
      continue;
    }
    Linearisation linear(system_);
    if (why = take_tangents(linear, next); !why.empty()) return why;
    if (!linear.factor({}, is_symmetric() ? solve::Symmetry::symmetric : solve::Symmetry::general).ok()) continue;
    if (is_symmetric() && linear.num_negative() != static_cast<int>(found_.size())) continue;
    state_ = next;
    return {};
  }
  return "the path of equilibria is not followed beyond the load factor " + io::rounded_text(last_critical_, 9) +
         (why.empty() ? "" : ": " + why);
}

/// A part of the way to a critical factor, or less where no equilibrium is found.
std::optional<std::string> Buckling::approach(double factor, double part) {
  double target = state_.time + part * (factor - state_.time);
  std::optional<std::string> why;
  for (int halvings = 0; halvings < most_halvings; ++halvings) {
    step::State next = state_;
    if (!(why = go_to(next, target))) {
      state_ = next;
      return std::nullopt;
    }
    target = 0.5 * (target + state_.time);
  }
  return why;
}

bool Buckling::find_next(std::vector<Found>& found, bool& is_last) {
  double part = part_of_way, before = 0.0, plain_before = 0.0, way_before = 0.0;
  if (!found_.empty())
    if (const std::string why = leave_behind(); !why.empty()) return fail(why);
  step::State previous = state_;
  const auto passed = static_cast<int>(found_.size());
  std::vector<Found> near;  // by the last estimate next to a critical factor: what is nearer may not be solved
  for (int k = 0; k < most_estimates; ++k) {
    const double difference = -std::max(1e-2 * std::abs(way_ - state_.time), small_part * way_);
    const Estimate now = state_.time > 0.0 ? estimate(std::max(difference, -0.3 * state_.time)) : first_estimate();
    if (!now.cause.empty() && !near.empty()) {
      found = std::move(near);
      return true;
    }
    if (!now.cause.empty())
      return fail(now.cause + (state_.time > 0.0 ? ""
                                                 : "; the structure without loads has to stand by itself, as under a "
                                                   "prescribed motion that tightens it"));
    if (is_symmetric() && now.loads.unstable > passed && state_.time > previous.time) {
      // The step has passed a critical factor that the estimate did not tell.
      state_ = previous;
      part *= 0.5;
      if (part < 1e-3) break;
      continue;
    }
    if (now.next.empty() || state_.time + now.next.front().distance > scene_.analysis.buckling.largest_factor) {
      is_last = true;
      return true;
    }
    is_counted_ = is_counted_ && now.loads.unstable == passed;
    // Estimates are off by the square of the way that was left, of which the last two tell how much.
    const double way = now.next.front().distance, plain = state_.time + way;
    const double share =
        before > 0.0 && way < 0.5 * way_before ? way * way / (way_before * way_before - way * way) : 0.0;
    const double factor = way_ = plain + share * (plain - plain_before);
    near.clear();
    if (std::abs(way) <= near_enough * factor)
      for (const step::CriticalLoad& load : now.next)
        near.push_back({factor + load.distance - way, before > 0.0 ? std::abs(factor / before - 1.0) : 1.0, load,
                        step::unstable_mode_of(system_, state_, load.shape)});
    plain_before = plain;
    way_before = way;
    const bool is_settled = std::abs(factor - before) <= settled_factor * factor;
    before = factor;
    previous = state_;
    if (near.empty() || !is_settled)
      if (const auto why = approach(factor, part); why && near.empty()) return fail(*why);
    if (!near.empty() && (is_settled || state_.time == previous.time)) {
      found = std::move(near);
      return true;
    }
    if (!may_try(factor)) return false;
  }
  return fail("the critical load factor near " + io::rounded_text(way_, 6) +
              " is not found: its estimates do not settle, as where the path of equilibria turns back before; "
              "\"arc_length\" of statics follows the path");
}

bool Buckling::take_step() {
  if (!may_try(way_)) return false;
  std::vector<Found> found;
  bool is_last = false;
  if (!find_next(found, is_last)) return false;
  step::StepReport report;
  report.converged = true;
  count(report);
  for (Found& one : found) found_.push_back(std::move(one));
  if (!found_.empty()) last_critical_ = found_.back().factor;
  if (is_last && found_.size() < static_cast<std::size_t>(scene_.analysis.buckling.count))
    note("no " + std::string(found_.empty() ? "" : "further ") + "critical load factor up to " +
         io::rounded_text(scene_.analysis.buckling.largest_factor, 6) + " was found");
  is_done_ = is_last || found_.size() >= static_cast<std::size_t>(scene_.analysis.buckling.count);
  return true;
}

void Buckling::sum_up() {
  records::Table table{
      "buckling",
      "",
      {{"mode", "", true}, {"load_factor", "", true}, {"state_at", "", true}, {"last_change"}, {"what", "", true}},
      {}};
  std::vector<step::Mode> shapes;
  for (const Found& one : found_) {
    table.rows.push_back({static_cast<double>(table.rows.size() + 1), one.factor, one.factor - one.load.distance,
                          one.change, StabilityWatch::describe(plan_, one.where)});
    step::Mode shape;
    shape.shape.assign(one.load.shape.begin(), one.load.shape.end());
    shapes.push_back(std::move(shape));
  }
  table.about = std::string(
                    "Load factors at which the tangent of the loaded structure is singular, about the shape that "
                    "it has there. ") +
                (!is_symmetric() ? "Some load has no potential: divergence alone is looked for."
                 : is_counted_   ? "No lower one is missing, by the signs of pivots of the tangent next to each."
                                 : "That no lower one is missing is not proved.");
  summary().tables.push_back(std::move(table));
  draw_modes(recording_, system_, state_, shapes);
}

}  // namespace

std::unique_ptr<Analysis> make_buckling(const Parts& parts) { return std::make_unique<Buckling>(parts); }

}  // namespace bough::run
