#pragma once
/// Rules that take a consistent state from step to step in time: generalized-alpha, backward differences, the
/// variational integrator.
#include <memory>

#include "bough/step/advance.hpp"

namespace bough::step {

/// A rule with the vectors that it keeps beside the state. Allocates when made, not afterwards.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// A rule on the same system that goes on from where this one is, with the state that belongs there.
  virtual std::unique_ptr<Integrator> clone() const = 0;

  /// Takes over a state that is consistent at its time (make_consistent), for steps of this size [s].
  virtual StartReport start(State& state, const StepOptions& options, double step_size) = 0;

  /// The steps to come have another size. Nothing happens where it is the present one.
  virtual StartReport change_step_size(State& state, const StepOptions& options, double step_size) = 0;

  /// One step of the present size to `end_time`, which is given so that no round-off of sizes adds up. Not converged:
  /// `state` is as it was.
  virtual StepReport advance(State& state, const StepOptions& options, double end_time) = 0;

  /// How much of the last step's motion vibrates faster than the step, from 0 to 1: of rules that do not damp such
  /// vibrations, else 0.
  virtual double unresolved() const { return 0.0; }

  /// Writes or reads what it keeps beside the state.
  virtual void checkpoint(records::Archive& /*archive*/) {}
  /// Writes element matrices that it has made itself to the solver, by LinearSolution::num_matrices, where it was read
  /// from an archive that has them; false: it has not made them. See System::checkpoint.
  virtual bool write_matrices(long /*matrices*/) { return false; }
};

/// The rule that the options name, for a system, which outlives it.
std::unique_ptr<Integrator> make_integrator(System& system, const scene::Solver& solver, const StepOptions& options);

}  // namespace bough::step
