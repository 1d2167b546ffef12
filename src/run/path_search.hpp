#pragma once
/// Points within one step along a path of equilibria: where the load turns, where it has its last value.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "bough/step/arc_length.hpp"

namespace bough::run {

/// A point that was looked for within a step.
struct PathPoint {
  double distance = 0.0;  ///< from the start of the step [-]
  step::State state;      ///< the equilibrium there; not located: the nearest that was met
  bool is_located = false;
  bool is_near = false;      ///< some equilibrium between the two places was met
  step::State extreme;       ///< the equilibrium of the largest load that was met; the least, where values rise
  bool is_passed = false;    ///< of a limit point: its load lies beyond that where the slope changes its sign
  double value = 0.0;        ///< what is left of the value there
  double width = 0.0;        ///< not located: of what is left between two places [-]
  double load_factor = 0.0;  ///< of a limit point; not located: by a parabola through both ends of the step
  std::string cause;         ///< why it was not located
};

/// A place on the path with the value whose sign tells on which side of the point it lies.
struct PathPlace {
  double distance = 0.0, value = 0.0, load_factor = 0.0;
};

class PathSearch {
 public:
  /// start, direction: of the step, an equilibrium and the path's direction there; iterations: counts those of Newton.
  PathSearch(step::ArcLengthPath& path, const step::State& start, const step::ArcLengthPath::Vectors& direction,
             long& iterations)
      : path_(path), start_(start), direction_(direction), iterations_(iterations) {}

  /// The equilibrium at a distance along the path, with its tangent set; `state` is of no use where that fails.
  [[nodiscard]] std::optional<step::Trouble> go_to(step::State& state, double distance);

  /// Where value(state) changes its sign between two places of the step, to `tolerance` of the value: regula falsi
  /// (Illinois), and halves where there is no equilibrium to be found at the distance that it asks for. At a limit
  /// point the stiffness is singular and may have no factor: the path is then met a little beside.
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
  constexpr double exact = 1e-12;       // of the step: no place lies between
  constexpr double near_enough = 1e-6;  // of the step: where trials end without having met the tolerance
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
