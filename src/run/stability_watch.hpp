#pragma once
/// Stability of the equilibria of a static run.
#include <optional>
#include <string>

#include "bough/records/run.hpp"
#include "bough/step/stability.hpp"

namespace bough::run {

class StabilityWatch {
 public:
  StabilityWatch(const scene::Scene& scene, step::System& system);

  /// Examines an equilibrium just found, whose tangents are present and were factored there or next to it. Returns its
  /// number of unstable directions. known: the result of stability().look() for the same tangents, if it was called.
  int look(const step::State& state, std::optional<step::StabilityLook> known = {});
  /// Examines the last equilibrium of the run, unless the scene declares unstable ones: its unstable mode, and its
  /// stability in the motions that the plan has left out. For the latter it makes a plan with all motions and evaluates
  /// it once.
  void look_at_end(const step::State& state);

  const records::Stability& seen() const { return seen_; }
  /// Result for the last equilibrium passed to look().
  step::StabilityLook last() const { return {seen_.is_known, seen_.unstable_directions}; }
  step::Stability& stability() { return stability_; }
  /// "'beam.8' moves most, along (0, 1, 0)"
  static std::string describe(const plan::Plan& plan, const step::UnstableMode& mode);

 private:
  void look_at_hidden(const step::State& state);

  const scene::Scene& scene_;
  step::System& system_;
  step::Stability stability_;
  records::Stability seen_;
  double last_factor_ = 0.0;
};

}  // namespace bough::run
