#pragma once
/// Search for points within one step along a path of equilibria: limit points, and given load factors.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "bough/step/arc_length.hpp"

namespace bough::run {

/// Result of a search for a point within a step.
struct PathPoint {
  double distance = 0.0;  ///< from the start of the step [-]
  step::State state;      ///< the equilibrium there or, if not located, the nearest one found
  bool is_located = false;
  bool is_near = false;      ///< some equilibrium between the two places was found
  step::State extreme;       ///< equilibrium with the largest load found (the smallest, if values rise)
  bool is_passed = false;    ///< limit point: an equilibrium beyond the load of the zero slope was found
  double value = 0.0;        ///< remaining value there
  double width = 0.0;        ///< not located: length of the remaining interval [-]
  double load_factor = 0.0;  ///< limit point; if not located, of a parabola over the step
  std::string cause;         ///< why it was not located
};

/// A place on the path. The sign of `value` tells on which side of the sought point it lies.
struct PathPlace {
  double distance = 0.0, value = 0.0, load_factor = 0.0;
};

class PathSearch {
 public:
  /// start, direction: equilibrium at the start of the step, and direction of the path there. iterations: Newton's
  /// iterations are added to it.
  PathSearch(step::ArcLengthPath& path, const step::State& start, const step::ArcLengthPath::Vectors& direction,
             long& iterations)
      : path_(path), start_(start), direction_(direction), iterations_(iterations) {}

  /// Finds the equilibrium at a distance along the path and sets the tangent there. If that fails, `state` is
  /// undefined.
  [[nodiscard]] std::optional<step::Trouble> go_to(step::State& state, double distance);

  /// Finds a zero of value(state) between two places of the step, to `tolerance` of the value, by regula falsi
  /// (Illinois). If no equilibrium is found at a trial distance, other parts of the interval are tried. At a limit
  /// point the stiffness is singular and may have no factorization; trials then move to equilibria beside it.
  template <class Value>
  PathPoint find(PathPlace from, PathPlace to, double tolerance, Value&& value);

 private:
  std::optional<step::Trouble> go_near(step::State& state, double& distance, const PathPlace& from,
                                       const PathPlace& to);

  step::ArcLengthPath& path_;
  const step::State& start_;
  const step::ArcLengthPath::Vectors& direction_;
  long& iterations_;
};

template <class Value>
PathPoint PathSearch::find(PathPlace from, PathPlace to, double tolerance, Value&& value) {
  constexpr int most_trials = 40;
  constexpr double exact = 1e-12;       // of the interval: smaller ones are not divided
  constexpr double near_enough = 1e-6;  // of the interval: located at this width, even if the tolerance is not met
  const double width = std::abs(to.distance - from.distance);
  const double sense = from.value > to.value ? 1.0 : -1.0;
  PathPoint nearest;
  step::State state;
  for (int k = 0; k < most_trials && !nearest.is_located; ++k) {
    double distance = (from.distance * to.value - to.distance * from.value) / (to.value - from.value);
    if (const auto trouble = go_near(state, distance, from, to)) {
      nearest.cause = trouble->text;
      break;
    }
    const PathPlace now{distance, value(state), state.time};
    if (!nearest.is_near || sense * (now.load_factor - nearest.extreme.time) > 0.0) nearest.extreme = state;
    if (!nearest.is_near || std::abs(now.value) <= std::abs(nearest.value)) {
      nearest.is_near = true;
      nearest.distance = distance;
      nearest.value = now.value;
      nearest.state = state;
    }
    nearest.is_located = std::abs(now.value) <= tolerance || std::abs(to.distance - from.distance) <= exact * width;
    if ((now.value < 0.0) == (to.value < 0.0)) {
      from.value *= 0.5;
    } else {
      from = to;
    }
    to = now;
  }
  nearest.width = std::abs(to.distance - from.distance);
  nearest.is_located = nearest.is_located || (nearest.is_near && nearest.width <= near_enough * width);
  if (nearest.is_located)
    nearest.cause.clear();
  else if (nearest.cause.empty())
    nearest.cause = "it was not met closely enough in " + std::to_string(most_trials) + " trials";
  return nearest;
}

}  // namespace bough::run
