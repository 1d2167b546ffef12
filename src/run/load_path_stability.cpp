/// Detection of bifurcations on the path of equilibria, and of steps that ended on another branch.
#include <algorithm>
#include <cmath>

#include "load_path.hpp"

namespace bough::run {

namespace {

constexpr int halvings = 24;  ///< bisections: the load factor of a bifurcation is known to 1e-7 of the part of a step
constexpr int most_bifurcations = 8;  ///< within a step
constexpr double beside = 1e-3;       ///< distance beside a bifurcation, of the rest of a step
constexpr double apart = 1e-5;  ///< of the rest of a step: distance of two equilibria that iterations do not resolve
constexpr double leap = 10.0;   ///< equilibria farther apart than this times their path are on two branches

}  // namespace

/// Along the path the number of unstable directions changes by one at a limit point of the load, or at a bifurcation,
/// where another branch crosses the path. If the number changes over a step and neither is found, the step ended on
/// another branch and is to be repeated with a shorter length.
std::string LoadPath::look_at_stability(double length, bool is_last_try, Step& step) {
  const step::StabilityLook look = stability_.stability().look();
  step.look = look;
  if (!look.is_known || !start_look_.is_known || look.unstable == start_look_.unstable) return {};
  // Next to a critical load of a slender structure round-off determines the signs of pivots.
  if (look.unstable > start_look_.unstable && !stability_.stability().find_mode(state_)) return {};
  const bool passes_limit = step.limit && (!step.stop || step.stops_after_limit);
  if (passes_limit && std::abs(look.unstable - start_look_.unstable) == 1) return {};
  std::string cause = "the number of unstable directions changes by more than the limit point in it explains";
  if (!passes_limit) {
    step.look.reset();
    const PathPlace to{length, static_cast<double>(look.unstable), step.last().time};
    PathPlace from{0.0, static_cast<double>(start_look_.unstable), start_.time};
    cause.clear();
    for (int k = 0; cause.empty() && from.value != to.value && k < most_bifurcations; ++k)
      cause = find_bifurcation(from, to, look.unstable, step);
    if (const auto t = path_->set_tangent(state_)) return t->text;
  }
  if (is_last_try && !cause.empty()) {
    note("from load factor " + std::to_string(start_.time) + " to " + std::to_string(step.last().time) +
         " the path may have changed to another branch: " + cause);
    cause.clear();
  }
  return cause;
}

/// Finds by bisection the first change of the number of unstable directions after `from`, and sets `from` behind it.
std::string LoadPath::find_bifurcation(PathPlace& from, PathPlace to, int unstable_there, Step& step) {
  PathSearch search = make_search();
  const double before = from.value, end = to.distance, width = end - from.distance;
  step::State stable = start_, beyond = step.last();
  bool has_stable = from.distance == 0.0;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (from.distance + to.distance);
    step::State state;
    if (const auto t = search.go_to(state, middle)) {
      if (k > halvings / 2) break;  // the tangent is singular there, and the bifurcation is known accurately enough
      return "a bifurcation in it was not met: " + t->text;
    }
    const step::StabilityLook look = stability_.stability().look();
    if (!look.is_known) return {};
    const bool is_before = look.unstable == static_cast<int>(before);
    (is_before ? from : to) = {middle, static_cast<double>(look.unstable), state.time};
    (is_before ? stable : beyond) = state;
    has_stable = has_stable || is_before;
  }
  if (has_stable && path_->distance(stable, beyond) > leap * (to.distance - from.distance) + apart * width)
    return "the number of unstable directions changes from " + std::to_string(static_cast<int>(before)) + " to " +
           std::to_string(unstable_there) + ", and there is neither a limit point nor a bifurcation";
  records::Bifurcation found{0.5 * (from.load_factor + to.load_factor), "", to.value > before};
  // The mode is unstable on one side of the bifurcation. At a small distance its curvature exceeds round-off.
  const double away = found.is_lost ? std::min(to.distance + beside * width, end)
                                    : std::max(from.distance - beside * width, 0.5 * from.distance);
  step::State state;
  if (away > 0.0 && !search.go_to(state, away))
    if (const auto mode = stability_.stability().find_mode(state)) found.mode = StabilityWatch::describe(plan_, *mode);
  step.bifurcations.push_back(std::move(found));
  from = to;
  return {};
}

void LoadPath::accept_bifurcation(records::Bifurcation&& b) {
  note("a bifurcation was passed at load factor " + std::to_string(b.load_factor) + ", where stability is " +
       (b.is_lost ? "lost" : "regained") + (b.mode.empty() ? "" : ": " + b.mode) +
       "; another branch of equilibria begins there");
  summary().bifurcations.push_back(std::move(b));
}

}  // namespace bough::run
