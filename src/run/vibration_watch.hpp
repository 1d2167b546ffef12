#pragma once
#include <optional>
#include <string>

#include "bough/results/balance.hpp"
#include "bough/step/integrator.hpp"

namespace bough::run {

inline constexpr const char* undamped =
    "the variational integrator does not damp vibrations that the step does not resolve; use generalized_alpha or a "
    "smaller step";

/// Detects vibrations that the step does not resolve. For the variational integrator, which does not damp them.
class VibrationWatch {
 public:
  /// To be called after an accepted step. Returns a note when such vibrations first make up a large part of the
  /// accelerations.
  std::optional<std::string> look(const step::Integrator& integrator, double time);
  bool seen() const { return seen_; }
  void checkpoint(records::Archive& archive) { archive(seen_, gaining_steps_); }
  /// To be called in every step once they were detected. Returns the cause to end the run if the energy stays above
  /// what the work of loads and drives explains, by more than `round_off` [J].
  std::optional<std::string> judge(const results::Balance& balance, double round_off, double time);

 private:
  bool seen_ = false;
  int gaining_steps_ = 0;
};

}  // namespace bough::run
