#include "polynomial_pieces.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace bough::laws {

namespace {

using Piece = PolynomialPieces::Piece;

/// Horner's rule for the value and the first two derivatives at once.
LawValue eval(const Piece& piece, double t) {
  const double s = (t - piece.start) / piece.width;
  double value = 0.0;
  double slope = 0.0;
  double half_bend = 0.0;
  for (std::size_t k = piece.coefficients.size(); k-- > 0;) {
    half_bend = half_bend * s + slope;
    slope = slope * s + value;
    value = value * s + piece.coefficients[k];
  }
  return {value, slope / piece.width, 2.0 * half_bend / (piece.width * piece.width)};
}

/// Antiderivative of one piece that takes `value` at `t`. Exact there, since eval() adds the last term last.
Piece integrate(const Piece& piece, double t, double value) {
  Piece result{piece.start, piece.width, {0.0}};
  for (std::size_t k = 0; k < piece.coefficients.size(); ++k) {
    result.coefficients.push_back(piece.coefficients[k] * piece.width / static_cast<double>(k + 1));
  }
  result.coefficients[0] = value - eval(result, t).value;
  return result;
}

}  // namespace

PolynomialPieces::PolynomialPieces(std::vector<Knot> knots, std::vector<Piece> pieces)
    : knots_(std::move(knots)), pieces_(std::move(pieces)) {}

std::size_t PolynomialPieces::piece_of(double t, Side side) const {
  const auto is_before = [side](const Knot& knot, double time) {
    return side == Side::right ? knot.time <= time : knot.time < time;
  };
  return static_cast<std::size_t>(std::lower_bound(knots_.begin(), knots_.end(), t, is_before) - knots_.begin());
}

LawValue PolynomialPieces::at(double t, Side side) const { return eval(pieces_[piece_of(t, side)], t); }

void PolynomialPieces::append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const {
  for (std::size_t k = piece_of(t_begin, Side::left); k < knots_.size() && knots_[k].time <= t_end; ++k) {
    if (knots_[k].order <= max_order) breaks.add(knots_[k].time);
  }
}

Jet<Interval> PolynomialPieces::range(double t_begin, double t_end) const {
  std::optional<Jet<Interval>> all;
  for (std::size_t i = piece_of(t_begin, Side::left); i < pieces_.size(); ++i) {
    if (i > 0 && knots_[i - 1].time > t_end) break;
    const Piece& piece = pieces_[i];
    const double from = i > 0 ? std::max(t_begin, knots_[i - 1].time) : t_begin;
    const double to = i < knots_.size() ? std::min(t_end, knots_[i].time) : t_end;
    const Jet<Interval> s{{(from - piece.start) / piece.width, (to - piece.start) / piece.width},
                          Interval(1.0 / piece.width),
                          Interval(0.0)};
    Jet<Interval> sum{};
    for (std::size_t k = piece.coefficients.size(); k-- > 0;)
      sum = sum * s + Jet<Interval>{piece.coefficients[k], Interval(0.0), Interval(0.0)};
    if (all)
      all = Jet<Interval>{hull(all->value, sum.value), hull(all->rate, sum.rate),
                          hull(all->acceleration, sum.acceleration)};
    else
      all = sum;
  }
  return *all;
}

Law PolynomialPieces::integral(double t0) const {
  std::vector<Knot> knots = knots_;
  for (Knot& knot : knots) ++knot.order;
  std::vector<Piece> pieces(pieces_.size());
  // Integrates from the piece that holds t0 outwards; each piece continues the value of its neighbour at their common
  // knot.
  const std::size_t home = piece_of(t0, Side::right);
  pieces[home] = integrate(pieces_[home], t0, 0.0);
  for (std::size_t i = home + 1; i < pieces.size(); ++i) {
    const double t = knots[i - 1].time;
    pieces[i] = integrate(pieces_[i], t, eval(pieces[i - 1], t).value);
  }
  for (std::size_t i = home; i-- > 0;) {
    const double t = knots[i].time;
    pieces[i] = integrate(pieces_[i], t, eval(pieces[i + 1], t).value);
  }
  return Law{std::make_shared<PolynomialPieces>(std::move(knots), std::move(pieces))};
}

bool PolynomialPieces::is_constant() const { return knots_.empty() && pieces_.front().coefficients.size() == 1; }

}  // namespace bough::laws
