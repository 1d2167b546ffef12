#pragma once

#include <cstddef>
#include <vector>

#include "node.hpp"

namespace bough::laws {

/// Polynomials between knots:  f(t) = sum_k c_k s^k,  s = (t - start) / width  of the piece that holds t.
/// n knots separate n + 1 pieces; the first and the last reach to infinity. Closed under integration.
class PolynomialPieces final : public Node {
 public:
  struct Knot {
    double time;  ///< [s]
    int order;    ///< lowest derivative that may jump here (0: the value)
  };
  struct Piece {
    double start;                      ///< time at which s = 0 [s]
    double width;                      ///< time over which s grows by 1 [s], > 0
    std::vector<double> coefficients;  ///< c_k, at least one
  };

  /// knots: n, times strictly increasing; pieces: n + 1.
  PolynomialPieces(std::vector<Knot> knots, std::vector<Piece> pieces);

  LawValue at(double t, Side side) const override;
  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override;
  Law integral(double t0) const override;
  Jet<Interval> range(double t_begin, double t_end) const override;
  bool is_constant() const override;

 private:
  std::size_t piece_of(double t, Side side) const;

  std::vector<Knot> knots_;
  std::vector<Piece> pieces_;
};

}  // namespace bough::laws
