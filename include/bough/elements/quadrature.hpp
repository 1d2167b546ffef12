#pragma once
/// Lagrange interpolation on N equidistant nodes over s in [0, 1], tabulated at Gauss points: values, slopes d/ds,
/// weights.
namespace bough::elements {

template <int N, int P>
struct ShapeRule {
  double weight[P];
  double shape[P][N];
  double slope[P][N];
};

/// N - 1 points: strains (reduced, free of locking).
template <int N>
const ShapeRule<N, N - 1>& strain_rule();
/// N points: mass and line loads.
template <int N>
const ShapeRule<N, N>& mass_rule();

/// Values of the N interpolation polynomials at s.
template <int N>
void eval_interpolation(double s, double* shape, double* slope);

}  // namespace bough::elements
