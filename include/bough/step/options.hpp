#pragma once
/// Options of a run in time or load.
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::step {

struct StepOptions {
  scene::Integrator integrator = scene::Integrator::generalized_alpha;
  double spectral_radius =
      0.8;                    ///< of generalized-alpha: rho_inf [-] at infinite frequency, 0 (most damping) to 1 (none)
  int bdf_order = 0;          ///< of backward differences: 2 or 3; 0: 3, but 2 where undamped vibrations would grow
  double newmark_beta = 0.3;  ///< of the variational integrator, for vibrations [-], 1/4 to 1
  double tolerance = 1e-8;    ///< [-] of changes of relative motions, and of residuals relative to what makes them
  int max_iterations = 20;    ///< Newton limit, >= 1
  int max_cuts = 10;          ///< halvings of a step before the run fails
  std::optional<scene::StepControl> step_control;  ///< none: steps of equal size
  std::optional<scene::ArcLength> arc_length;      ///< statics: none: load steps
  bool reuse_factors = true;     ///< dynamics: over iterations and steps, while they contract (plan decision "reuse")
  bool single_solution = false;  ///< one linear solution per step, no convergence asked for (linearly implicit)
};

StepOptions make_step_options(const scene::Analysis& analysis);
std::vector<std::string> problems_in(const StepOptions& options);

/// Coefficients of generalized-alpha (Chung, Hulbert 1993), functions of the spectral radius alone.
///   alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 + alpha_f - alpha_m, beta = (gamma +
///     1/2)^2 / 4
struct AlphaCoefficients {
  double alpha_m, alpha_f, beta, gamma;
  double shift() const {
    return alpha_m - alpha_f;
  }  ///< a_n stands for dv/dt at t_n + shift h (Arnold, Bruls, Cardona 2015)
  /// Constants C_q and C_v of the local errors of increments and velocities (step_control.hpp).
  double error_of_increments() const { return beta + 0.5 * shift() - 1.0 / 6.0; }
  double error_of_velocities() const;
};
AlphaCoefficients make_alpha_coefficients(double spectral_radius);

}  // namespace bough::step
