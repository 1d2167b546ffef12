#pragma once
/// An independent reference: planar geometrically exact rods as boundary value problems, solved by shooting. It has no
/// code in common with the elements.
#include <functional>
#include <vector>

namespace bough::stress {

/// A uniform piece of a rod.
struct RodPiece {
  double length = 1.0;
  double EA = 0.0, GA = 0.0, EI = 0.0;  ///< [N, N, N m^2]
  double curvature = 0.0;               ///< unloaded [1/m]
  double kink = 0.0;                    ///< turn at its start [rad]
};

/// One section: place [m], direction of the section's normal [rad], and what the part beyond exerts on the part
/// before: moment [N m], force along x and y [N].
struct RodSection {
  double x = 0.0, y = 0.0, theta = 0.0, moment = 0.0, fx = 0.0, fy = 0.0;
  double normal_force() const;
  double shear_force() const;
};

/// Takes a section from the start of a piece to its end (Reissner 1972):
///   x' = (1 + N/EA) cos(theta) - Q/GA sin(theta),  y' = (1 + N/EA) sin(theta) + Q/GA cos(theta),  theta' = curvature
///     + M/EI,
///   M' = y' Fx - x' Fy,  N = Fx cos + Fy sin,  Q = Fy cos - Fx sin
/// by the classical Runge-Kutta rule in `steps` steps; its error is that of order four.
RodSection along(const RodPiece& piece, RodSection start, int steps = 4000);

/// Solves for unknowns at which all residuals vanish, by Newton's method with difference quotients, from a guess.
/// Throws std::runtime_error where it does not converge to `tolerance` (of the residuals, which the caller makes
/// dimensionless).
std::vector<double> shoot(const std::function<std::vector<double>(const std::vector<double>&)>& residuals,
                          std::vector<double> guess, double tolerance = 1e-12);

/// Cantilever along x from a clamp at the origin under a dead force (fx, fy) on its tip; sections at the ends of the
/// pieces, the clamp first.
std::vector<RodSection> cantilever_rod(const std::vector<RodPiece>& pieces, double fx, double fy);

}  // namespace bough::stress
