#include "bough/elements/quadrature.hpp"

#include <cmath>

namespace bough::elements {

template <int N>
void eval_interpolation(double s, double* shape, double* slope) {
  for (int i = 0; i < N; ++i) {
    double value = 1.0, derivative = 0.0;
    for (int j = 0; j < N; ++j) {
      if (j == i) continue;
      const double width = static_cast<double>(i - j) / (N - 1);
      derivative = (derivative * (s - static_cast<double>(j) / (N - 1)) + value) / width;
      value *= (s - static_cast<double>(j) / (N - 1)) / width;
    }
    shape[i] = value;
    slope[i] = derivative;
  }
}

namespace {

/// Gauss-Legendre points and weights on [0, 1], by Newton on the Legendre recurrence.
template <int P>
void gauss(double* point, double* weight) {
  constexpr double pi = 3.14159265358979323846;
  for (int i = 0; i < P; ++i) {
    double x = std::cos(pi * (i + 0.75) / (P + 0.5)), slope = 1.0;
    for (int iteration = 0; iteration < 50; ++iteration) {
      double p0 = 1.0, p1 = x;
      for (int k = 2; k <= P; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = P == 0 ? 1.0 : P * (x * p1 - p0) / (x * x - 1.0);
      const double step = p1 / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    point[P - 1 - i] = 0.5 * (1.0 + x);
    weight[P - 1 - i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
}

template <int N, int P>
ShapeRule<N, P> make_rule() {
  ShapeRule<N, P> rule;
  double point[P];
  gauss<P>(point, rule.weight);
  for (int g = 0; g < P; ++g) eval_interpolation<N>(point[g], rule.shape[g], rule.slope[g]);
  return rule;
}

}  // namespace

template <int N>
const ShapeRule<N, N - 1>& strain_rule() {
  static const ShapeRule<N, N - 1> rule = make_rule<N, N - 1>();
  return rule;
}
template <int N>
const ShapeRule<N, N>& mass_rule() {
  static const ShapeRule<N, N> rule = make_rule<N, N>();
  return rule;
}

template void eval_interpolation<2>(double, double*, double*);
template void eval_interpolation<3>(double, double*, double*);
template void eval_interpolation<4>(double, double*, double*);
template const ShapeRule<2, 1>& strain_rule<2>();
template const ShapeRule<3, 2>& strain_rule<3>();
template const ShapeRule<4, 3>& strain_rule<4>();
template const ShapeRule<2, 2>& mass_rule<2>();
template const ShapeRule<3, 3>& mass_rule<3>();
template const ShapeRule<4, 4>& mass_rule<4>();

}  // namespace bough::elements
