#pragma once
/// Whether the steps of a run see the laws of time: a pulse shorter than a step lies between the ends of steps, and a
/// wave faster than they are looks like a slow one.
#include <cstddef>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/archive.hpp"

namespace bough::run {

/// An integrator knows laws at the ends of steps, so that what it sees of the impulse of a step is the trapezoidal sum.
/// For each law the integral is compared with that sum, step by step, and the law of a prescribed place with the
/// straight line over the step. Stretches of steps in which the bound of the second derivative leaves no room for a
/// difference are passed over; the others are halved down to single steps, the largest bound first. Bounds are
/// rigorous: however short a pulse is, it is found.
class LawWatch {
 public:
  explicit LawWatch(const plan::Plan& plan);

  /// Adds an accepted step.
  void pass(double begin, double end);
  /// Which law the steps do not see, in words; empty: they see all.
  std::string text() const;
  void checkpoint(records::Archive& archive) { archive(stretches_); }

 private:
  struct Stretch {
    double begin, step;
    long steps;
  };
  const plan::Plan& plan_;
  std::vector<Stretch> stretches_;  ///< steps of equal size, in order
};

}  // namespace bough::run
