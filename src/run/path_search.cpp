#include "path_search.hpp"

namespace bough::run {

namespace {

constexpr double aside = 1e-5;  ///< first distance from a singular point, of the interval; then four times as far
constexpr int most_asides = 8;

}  // namespace

std::optional<step::Trouble> PathSearch::go_to(step::State& state, double distance) {
  state = start_;
  path_.set_direction(direction_);
  if (auto t = path_.set_tangent(state)) return t;
  const step::StepReport report = path_.advance(state, distance);
  iterations_ += report.iterations;
  if (!report.converged) return step::Trouble{report.cause};
  path_.accept();
  return path_.set_tangent(state);
}

/// Finds an equilibrium at the given distance, or a little before it, or at other parts of the interval. Sets
/// `distance`.
std::optional<step::Trouble> PathSearch::go_near(step::State& state, double& distance, const PathPlace& from,
                                                 const PathPlace& to) {
  auto trouble = go_to(state, distance);
  const double begin = std::min(from.distance, to.distance), width = std::abs(to.distance - from.distance);
  double away = aside * width;
  for (int i = 0; trouble && i < most_asides && distance - away > begin; ++i, away *= 4.0) {
    distance -= away;
    trouble = go_to(state, distance);
  }
  for (const double part : {0.5, 0.25, 0.75, 0.9}) {
    if (!trouble) break;
    distance = begin + part * width;
    trouble = go_to(state, distance);
  }
  return trouble;
}

}  // namespace bough::run
