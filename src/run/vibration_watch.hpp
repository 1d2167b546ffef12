#pragma once
#include <optional>
#include <string>

#include "bough/results/balance.hpp"
#include "bough/step/integrator.hpp"

namespace bough::run {

inline constexpr const char* undamped =
    "the variational integrator does not damp vibrations that the step does not resolve; use generalized_alpha or a "
    "smaller step";

/// Looks at the steps of the variational integrator, which damps nothing, for vibrations faster than the step.
class VibrationWatch {
 public:
  /// After an accepted step: a note when they first make up a good part of the accelerations.
  std::optional<std::string> look(const step::Integrator& integrator, double time);
  bool seen() const { return seen_; }
  /// Every step once they were seen: why the run has to end, where energy keeps above what work explains.
  std::optional<std::string> judge(const results::Balance& balance, double time);

 private:
  bool seen_ = false;
  int gaining_steps_ = 0;
};

}  // namespace bough::run
