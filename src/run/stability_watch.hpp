#pragma once
/// Stability of the equilibria of a static run.
#include <optional>
#include <string>

#include "bough/records/run.hpp"
#include "bough/step/stability.hpp"
#include "other_motions.hpp"

namespace bough::run {

class StabilityWatch {
 public:
  StabilityWatch(const scene::Scene& scene, step::System& system);

  /// Examines an equilibrium just found, whose tangents are present and were factored there or next to it. Returns its
  /// number of unstable directions. known: the result of stability().look() for the same tangents, if it was called.
  int look(const step::State& state, std::optional<step::StabilityLook> known = {});
  /// Examines the last equilibrium of the run, unless the scene declares unstable ones: its unstable mode, and its
  /// stability in the motions that the plan has left out and, under loads that have no potential, vibrations about it.
  /// For these it makes plans of their own and evaluates each once.
  void look_at_end(const step::State& state);
  /// After look_at_end: how vibrations grow, in words; empty: they do not, as far as it is known.
  const std::string& flutter() const { return flutter_.text; }
  /// What of stability was not examined, in words; empty: nothing, or unstable equilibria are declared.
  std::string not_examined() const;

  const records::Stability& seen() const { return seen_; }
  /// Result for the last equilibrium passed to look().
  step::StabilityLook last() const { return {seen_.is_known, seen_.unstable_directions}; }
  step::Stability& stability() { return stability_; }
  void checkpoint(records::Archive& archive) { archive(stability_, seen_, last_factor_); }
  /// "'beam.8' moves most, along (0, 1, 0)"
  static std::string describe(const plan::Plan& plan, const step::UnstableMode& mode);

 private:
  const scene::Scene& scene_;
  step::System& system_;
  step::Stability stability_;
  records::Stability seen_;
  double last_factor_ = 0.0;
  HiddenMotions::Look hidden_look_;
  FlutterLook flutter_;
};

}  // namespace bough::run
