#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bough::laws {

/// Value of a law with its first two derivatives in time: f [u], df/dt [u/s], d2f/dt2 [u/s^2].
struct LawValue {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

/// Breakpoints of a law that a search has found.
struct Breaks {
  std::vector<double> times;  ///< sorted, unique [s]
  bool is_cut = false;  ///< there are more than requested, or the search was given up for too many undecided places
  double work = 0.0;    ///< number of formula instructions that the search executed
};

/// Side from which the limit is taken where a law or one of its derivatives jumps.
enum class Side { left, right };

class Node;  // one kind of law (src/laws/node.hpp)

/// A function of time t [s] with its first two derivatives. Immutable and a value: copies share the data, and every
/// member may be called from several threads at once. Default-constructed: zero. Made by the factories of make_law.hpp.
class Law {
 public:
  Law() = default;
  explicit Law(std::shared_ptr<const Node> node) : node_(std::move(node)) {}

  /// Value and derivatives at t [s]; where something jumps, the limit from the given side.
  /// Derivatives are those of the smooth branch on that side: a jump of the value adds no impulse to the rate.
  /// The result is not finite where the law is not (a pole, a root of a negative number); see non_finite(). Never
  /// throws.
  LawValue at(double t, Side side = Side::right) const;

  /// Times in [t_begin, t_end] [s] at which the value or one of its first two derivatives jumps; sorted, unique.
  /// A time integrator ends a step there. It may name a few times too many (a product of a jump with a zero, the joints
  /// of pieces that happen to fit), never one too few, except as stated for formulas (make_expression). Allocates.
  std::vector<double> breakpoints(double t_begin, double t_end) const;

  /// The same, but the search ends once there are more than `most`: a formula may have any number of them in any
  /// interval. Its cost grows with `most`, not with the number of breakpoints that exist.
  Breaks breakpoints(double t_begin, double t_end, std::size_t most) const;

  /// The antiderivative that vanishes at t0 [s]:  F(t) = int_t0^t f(s) ds,  F' = f,  F'' = f'.
  /// Closed form for constants, ramps, tables, harmonics and for sums, multiples and pieces of those; adaptive
  /// quadrature to round-off for products and formulas. Its value does not depend on the order of calls.
  Law integral(double t0) const;

  /// True where the law is known to be the same at all times (by construction, not by trial).
  bool is_constant() const;

  /// The integrand if this law is an integral by quadrature; empty if it has a closed form. A value of such an integral
  /// may cost a quadrature from its start on, and is NaN where that exceeds the limits of make_law.hpp.
  std::optional<Law> integrand() const;

  /// The implementation behind this value, null for zero. For use within this layer only.
  const Node* node() const { return node_.get(); }

 private:
  std::shared_ptr<const Node> node_;  // none: zero
};

/// Says which of value, rate and acceleration is not finite, or nothing where all are.
/// The caller names the law and the time; the law itself returns what its formula gives and never replaces it.
std::optional<std::string> non_finite(const LawValue& law_value);

}  // namespace bough::laws
