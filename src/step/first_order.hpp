#pragma once
/// The formulas of one step of generalized-alpha for x' = f. Internal to step.
///   (1 - alpha_m) a_{n+1} + alpha_m a_n = (1 - alpha_f) x'_{n+1} + alpha_f x'_n
///   x_{n+1} = x_n + h ((1 - gamma) a_n + gamma a_{n+1}),   x'_{n+1} = f at t_{n+1}
///   alpha_m = (3 rho - 1) / (2 (rho + 1)),  alpha_f = rho / (rho + 1),  gamma = 1/2 - alpha_m + alpha_f
/// of second order, and with the spectral radius rho at infinite step sizes, as the rule for motions.
/// Source: Jansen, Whiting, Hulbert 2000, in the notation of Arnold, Bruls 2007.
namespace bough::step {

struct FirstOrderRule {
  double alpha_m, alpha_f, gamma, h;

  FirstOrderRule(double spectral_radius, double step_size)
      : alpha_m((3.0 * spectral_radius - 1.0) / (2.0 * (spectral_radius + 1.0))),
        alpha_f(spectral_radius / (spectral_radius + 1.0)),
        gamma(0.5 - alpha_m + alpha_f),
        h(step_size) {}

  /// a_n belongs to the time t_n + shift h.
  double shift() const { return alpha_m - alpha_f; }
  /// d(x'_{n+1}) / d(x_{n+1}) [1/s]
  double slope() const { return (1.0 - alpha_m) / ((1.0 - alpha_f) * gamma * h); }

  double algorithmic(double x, double x_n, double a_n) const {
    return (x - x_n) / (gamma * h) - (1.0 - gamma) / gamma * a_n;
  }
  double rate(double a, double a_n, double rate_n) const {
    return ((1.0 - alpha_m) * a + alpha_m * a_n - alpha_f * rate_n) / (1.0 - alpha_f);
  }
  /// The x_{n+1} at which x'_{n+1} has this value.
  double predict(double rate, double x_n, double a_n, double rate_n) const {
    const double a = ((1.0 - alpha_f) * rate + alpha_f * rate_n - alpha_m * a_n) / (1.0 - alpha_m);
    return x_n + h * ((1.0 - gamma) * a_n + gamma * a);
  }
};

}  // namespace bough::step
