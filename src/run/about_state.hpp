#pragma once
/// What all analyses have in common that linearise the equations about a state: which state it is, whether it rests or
/// moves steadily, and from which axes the equations are the same at all times.
#include <string>
#include <utility>
#include <vector>

#include "bough/step/linearisation.hpp"
#include "bough/step/modes.hpp"
#include "bough/step/options.hpp"

namespace bough::run {

class AboutState {
 public:
  /// Keeps the references. `state` is that of the scene at time 0.
  AboutState(const scene::Scene& scene, step::System& system, step::State& state, const step::StepOptions& options);

  /// Takes the consistent state of time 0, or moves `state` to the equilibrium that Analysis::start asks for. Returns why
  /// there is none; empty: there is.
  [[nodiscard]] std::string find();
  /// Evaluates K, C and M at the state, looks whether it is in balance, and describes motions about a state that moves
  /// from the ground or from the parts (look_at_steadiness). Returns why that fails; empty: it does not.
  [[nodiscard]] std::string linearise(step::Linearisation& linear);
  /// Looks for modes: symmetric equations have real ones, all others complex ones. Dampers are left out unless they are
  /// asked for, in `linear` too.
  step::ModesFound find_modes(step::Linearisation& linear, const scene::ModesAsked& asked);

  bool moves() const { return moves_; }                    ///< known once it was linearised
  bool is_from_ground() const { return is_from_ground_; }  ///< of a state that moves
  int iterations() const { return iterations_; }           ///< of Newton's method
  /// "the equilibrium under the loads of time 0, which turns: frequencies are those seen from the ground"
  std::string text() const;
  /// What is to be told and was not taken yet.
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }
  /// Why the state is none about which equations can be linearised, in words; empty: it is one.
  std::vector<std::string> doubts() const;
  void checkpoint(records::Archive& archive) { archive(imbalance_, unsteady_, moves_, is_from_ground_); }

 private:
  std::string find_equilibrium();
  bool is_at_rest() const;
  void look_at_balance(const step::Linearisation& linear);

  const scene::Scene& scene_;
  const plan::Plan& plan_;
  step::System& system_;
  step::State& state_;
  const step::StepOptions& options_;
  bool moves_ = false, is_from_ground_ = false;
  double moved_ = 0.0;
  int iterations_ = 0;
  std::vector<std::string> notes_;
  std::string imbalance_, unsteady_;
};

}  // namespace bough::run
