#pragma once
/// Zeros and maxima of a function of one variable, without derivatives. No allocation.
#include <cmath>
#include <utility>

namespace bough::run {

/// Finds a zero of a continuous f between a and b, to `tolerance`, by regula falsi (Illinois). fa = f(a) and fb = f(b)
/// must have opposite signs.
template <class F>
double find_zero(F&& f, double a, double b, double fa, double fb, double tolerance) {
  constexpr int most_trials = 60;
  double x = b;
  for (int k = 0; k < most_trials && std::abs(b - a) > tolerance && fb != 0.0; ++k) {
    x = (a * fb - b * fa) / (fb - fa);
    const double fx = f(x);
    if (std::abs(x - b) <= tolerance) break;
    if ((fx < 0.0) == (fb < 0.0)) {
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
    }
    b = x;
    fb = fx;
  }
  return x;
}

/// Finds the maximum of f between a and b, to `tolerance`, if there is only one, by golden section and parabolas
/// through the last three places (Brent 1973, chapter 5). Returns its place and its value.
template <class F>
std::pair<double, double> find_maximum(F&& f, double a, double b, double tolerance) {
  constexpr int most_trials = 60;
  constexpr double golden = 0.3819660112501051;
  double x = a + golden * (b - a), w = x, v = x, fx = f(x), fw = fx, fv = fx, step = 0.0, before = 0.0;
  for (int k = 0; k < most_trials; ++k) {
    const double middle = 0.5 * (a + b);
    if (std::abs(x - middle) <= 2.0 * tolerance - 0.5 * (b - a)) break;
    const double r = (x - w) * (fx - fv), q = (x - v) * (fx - fw);
    const double numerator = (x - v) * q - (x - w) * r, denominator = 2.0 * (q - r);
    const double parabola = denominator != 0.0 ? -numerator / denominator : 0.0;
    const bool is_inside = x + parabola > a && x + parabola < b;
    if (denominator != 0.0 && is_inside && std::abs(parabola) < 0.5 * std::abs(before)) {
      before = step;
      step = parabola;
    } else {
      before = x < middle ? b - x : a - x;
      step = golden * before;
    }
    const double u = x + (std::abs(step) >= tolerance ? step : std::copysign(tolerance, step)), fu = f(u);
    if (fu >= fx) {
      (u < x ? b : a) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
    } else {
      (u < x ? a : b) = u;
      if (fu >= fw || w == x) {
        v = w, fv = fw, w = u, fw = fu;
      } else if (fu >= fv || v == x || v == w) {
        v = u, fv = fu;
      }
    }
  }
  return {x, fx};
}

}  // namespace bough::run
