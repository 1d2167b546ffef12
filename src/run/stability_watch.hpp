#pragma once
/// What a run in statics has seen of the stability of its equilibria.
#include <optional>
#include <string>

#include "bough/records/run.hpp"
#include "bough/step/stability.hpp"

namespace bough::run {

class StabilityWatch {
 public:
  StabilityWatch(const scene::Scene& scene, step::System& system);

  /// An equilibrium that was just found, whose tangents are present and were factored there or next to it. Returns the
  /// directions in which it is left. known: what stability().look() has told of the same tangents, where it was asked.
  int look(const step::State& state, std::optional<step::StabilityLook> known = {});
  /// The last equilibrium of the run, unless unstable ones are declared: what moves in its unstable direction, and
  /// whether it is stable in the motions that the plan has left out. Makes a plan with these, and evaluates it once.
  void look_at_end(const step::State& state);

  const records::Stability& seen() const { return seen_; }
  /// Of the last equilibrium that look() was called for.
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
