#pragma once
/// A scene under the test's own step sizes: the verbs of step without the run around them.
#include <optional>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/step/integrator.hpp"

namespace bough::support {

/// What a time integrator computes, as plain numbers.
struct Sample {
  double time = 0.0;
  std::vector<double> positions, velocities, multipliers;  ///< R and x of all nodes; twists, own axes; reactions
};

class Stepper {
 public:
  explicit Stepper(const scene::Scene& scene);  ///< integrator, spectral radius, tolerance: the scene's
  ~Stepper();                                   ///< expects all linear solutions to have been sound
  step::StepOptions& options() { return options_; }
  step::System& system() { return system_; }
  step::State& state() { return state_; }

  /// Consistent start and first step size; throws std::runtime_error with the cause of a failure, as all below.
  step::StartReport start(double step_size);
  void change(double step_size);  ///< of the steps to come
  void step(double end_time);     ///< by the present step size: end_time says it without round-off
  Sample sample() const;

 private:
  plan::Plan plan_;
  step::System system_;
  step::State state_;
  step::StepOptions options_;
  std::unique_ptr<step::Integrator> integrator_;
};

/// Largest |a - b| relative to the largest |b|, of each part.
struct Difference {
  double positions = 0.0, velocities = 0.0, multipliers = 0.0;
  void include(const Sample& a, const Sample& b, const Sample& scale);
};

/// Largest magnitudes over a run, one number in each part: the scale of differences.
Sample scale_of(const std::vector<Sample>& run);

/// Steps of one size from the start, and samples of it and of the ends of the steps of size `sampling`.
std::vector<Sample> march(const scene::Scene& scene, double h, double sampling, int samples);

/// Largest differences over samples [first, last] of `run`, whose sampling is `ratio` times that of the reference.
Difference compare(const std::vector<Sample>& run, const std::vector<Sample>& reference, std::size_t first,
                   std::size_t last, std::size_t ratio);

}  // namespace bough::support
