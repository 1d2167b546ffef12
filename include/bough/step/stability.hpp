#pragma once
/// Stability of equilibria in statics, by the inertia of the tangent.
///
/// With K the tangent of what is free and G the gradients of the constraint rows, the matrix of Newton's method is [K
/// G^T; G 0]. By Sylvester's law it has as many negative eigenvalues as its symmetric factor L D L^T has negative
/// pivots, and
///   negative eigenvalues of [K G^T; G 0] = negative eigenvalues of K on ker G + rank of G.
/// The first on the right are the directions in which an equilibrium under conservative loads is left. Loads that have
/// no potential make K unsymmetric: the sign of the determinant then tells whether their number is odd; an even
/// number, and flutter, are not seen.
#include <memory>
#include <optional>
#include <vector>

#include "bough/step/linearisation.hpp"

namespace bough::step {

/// What is known of the stability of an equilibrium.
struct StabilityLook {
  bool is_known = false;
  int unstable = 0;  ///< directions in which it is left; loads without a potential: 1 where their number is odd, else 0
};

/// A direction in which an equilibrium is left.
struct UnstableMode {
  int node = 0;                    ///< that moves most
  motion::Vec3<double> direction;  ///< of its displacement, or axis of its rotation; unit, in the axes of the ground
  bool turns = false;              ///< the mode is one of rotations alone
};

/// Of motions by unknown, the node that moves most, or that turns most where nothing moves.
UnstableMode unstable_mode_of(const System& system, const State& state, const std::vector<double>& x);

class Stability {
 public:
  explicit Stability(System& system);
  /// A copy makes its own factors where it needs them.
  Stability(const Stability& other) : system_(other.system_), num_rows_(other.num_rows_), last_(other.last_) {}

  void checkpoint(records::Archive& archive) { archive(last_); }

  bool is_conservative() const { return system_.plan().not_conservative.empty(); }

  /// Reads the pivots of the present factor, which is to be that of an equilibrium or nearly so. Where rows were
  /// exchanged in it, and where the answer differs from the last one, the tangents that are present are factored
  /// symmetrically. Allocates where it does so for the first time.
  StabilityLook look();

  /// Factors the tangents that are present. Directions that nothing holds are taken for stable.
  StabilityLook look_closely();

  /// A direction in which the equilibrium whose tangents are present is left, by inverse iteration on the kernel of
  /// the constraints; nothing where the negative curvature found is no more than the round-off of what makes it.
  std::optional<UnstableMode> find_mode(const State& state);

 private:
  StabilityLook read(const solve::Inertia& inertia, int deficiency) const;
  bool factor_copy(double shift, double relative_shift);
  StabilityLook read_copy();
  double iterate(std::vector<double>& x, std::vector<double>& y);

  System& system_;
  int num_rows_ = 0;  ///< of constraints, of which the solver knows
  int last_ = 0;
  std::unique_ptr<Linearisation> copy_;  ///< made when first needed
};

}  // namespace bough::step
