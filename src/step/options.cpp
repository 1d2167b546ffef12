#include "bough/step/options.hpp"

namespace bough::step {

StepOptions make_step_options(const scene::Analysis& a) {
  StepOptions o;
  o.integrator = a.integrator;
  o.spectral_radius = a.spectral_radius;
  o.newmark_beta = a.newmark_beta;
  o.bdf_order = a.bdf_order;
  o.tolerance = a.tolerance;
  o.max_iterations = a.max_iterations;
  o.max_cuts = a.max_cuts;
  o.step_control = a.step_control;
  o.arc_length = a.arc_length;
  o.single_solution = a.newton == scene::Newton::single;
  return o;
}

std::vector<std::string> problems_in(const StepOptions& o) {
  std::vector<std::string> problems;
  if (!(o.spectral_radius >= 0.0 && o.spectral_radius <= 1.0))
    problems.push_back("spectral_radius must be between 0 and 1");
  if (!(o.newmark_beta >= 0.25 && o.newmark_beta <= 1.0)) problems.push_back("newmark_beta must be between 0.25 and 1");
  if (o.bdf_order != 0 && o.bdf_order != 2 && o.bdf_order != 3) problems.push_back("bdf_order must be 2 or 3");
  if (!(o.tolerance > 0.0 && o.tolerance < 1.0)) problems.push_back("tolerance must be between 0 and 1");
  if (o.max_iterations < 1) problems.push_back("max_iterations must be at least 1");
  if (o.max_cuts < 0) problems.push_back("max_cuts must not be negative");
  if (o.step_control && !(o.step_control->tolerance > 0.0 && o.step_control->tolerance < 1.0))
    problems.push_back("the tolerance of step_control must be between 0 and 1");
  return problems;
}

AlphaCoefficients make_alpha_coefficients(double rho) {
  AlphaCoefficients c;
  c.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
  c.alpha_f = rho / (rho + 1.0);
  c.gamma = 0.5 + c.alpha_f - c.alpha_m;
  c.beta = 0.25 * (c.gamma + 0.5) * (c.gamma + 0.5);
  return c;
}

double AlphaCoefficients::error_of_velocities() const {
  const double d = shift();
  const double kappa = 0.5 * (1.0 - alpha_f - (1.0 - alpha_m) * (1.0 + 2.0 * d) - d * d);
  return kappa - 0.5 * d * d + 1.0 / 12.0;
}

}  // namespace bough::step
