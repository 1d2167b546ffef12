#pragma once
/// Integrates a scene with step sizes chosen by a test, by the functions of the layer step alone.
#include <optional>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/step/integrator.hpp"

namespace bough::support {

/// The results of a time integrator as plain numbers.
struct Sample {
  double time = 0.0;
  std::vector<double> positions, velocities, multipliers;  ///< R and x of all nodes; twists, own axes; reactions
};

class Stepper {
 public:
  explicit Stepper(const scene::Scene& scene);  ///< integrator, spectral radius, tolerance: the scene's
  ~Stepper();                                   ///< expects small residuals of all linear solutions
  step::StepOptions& options() { return options_; }
  step::System& system() { return system_; }
  step::State& state() { return state_; }

  /// Makes the initial state consistent and sets the first step size. Throws std::runtime_error with the cause of a
  /// failure, as all functions below.
  step::StartReport start(double step_size);
  void change(double step_size);  ///< sets the size of later steps
  void step(double end_time);     ///< of the present step size; end_time gives its end without round-off
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

/// Largest magnitudes over a run, one number for each part, as scales of differences.
Sample scale_of(const std::vector<Sample>& run);

/// Takes steps of one size from the start. Samples are the start and the ends of intervals of length `sampling`.
std::vector<Sample> march(const scene::Scene& scene, double h, double sampling, int samples);

/// Largest differences over samples [first, last] of `run`, whose sampling is `ratio` times that of the reference.
Difference compare(const std::vector<Sample>& run, const std::vector<Sample>& reference, std::size_t first,
                   std::size_t last, std::size_t ratio);

}  // namespace bough::support
