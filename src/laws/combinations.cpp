// Sums, multiples, products and pieces of other laws.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "harmonic.hpp"
#include "node.hpp"
#include "polynomial_pieces.hpp"
#include "quadrature.hpp"

namespace bough::laws {

namespace {

struct Term {
  double factor;
  Law law;
};

/// f = sum_i factor_i law_i, added in the order given.
class LinearCombination final : public Node {
 public:
  explicit LinearCombination(std::vector<Term> terms) : terms_(std::move(terms)) {}

  LawValue at(double t, Side side) const override {
    LawValue sum;
    for (const Term& term : terms_) {
      const LawValue x = term.law.at(t, side);
      sum.value += term.factor * x.value;
      sum.rate += term.factor * x.rate;
      sum.acceleration += term.factor * x.acceleration;
    }
    return sum;
  }
  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    for (const Term& term : terms_) laws::append_breaks(term.law, t_begin, t_end, max_order, breaks);
  }
  Jet<Interval> range(double t_begin, double t_end) const override {
    Jet<Interval> sum{};
    for (const Term& term : terms_)
      sum = sum + Jet<Interval>{term.factor, Interval(0.0), Interval(0.0)} * range_of(term.law, t_begin, t_end);
    return sum;
  }
  Law integral(double t0) const override {
    std::vector<Term> terms;
    for (const Term& term : terms_) terms.push_back({term.factor, term.law.integral(t0)});
    return Law{std::make_shared<LinearCombination>(std::move(terms))};
  }

 private:
  std::vector<Term> terms_;
};

/// f = a b,  f' = a' b + a b',  f'' = a'' b + 2 a' b' + a b''.
class Product final : public Node {
 public:
  Product(Law a, Law b) : a_(std::move(a)), b_(std::move(b)) {}

  LawValue at(double t, Side side) const override {
    const LawValue a = a_.at(t, side);
    const LawValue b = b_.at(t, side);
    return {a.value * b.value, a.rate * b.value + a.value * b.rate,
            a.acceleration * b.value + 2.0 * (a.rate * b.rate) + a.value * b.acceleration};
  }
  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    laws::append_breaks(a_, t_begin, t_end, max_order, breaks);
    laws::append_breaks(b_, t_begin, t_end, max_order, breaks);
  }
  Jet<Interval> range(double t_begin, double t_end) const override {
    return range_of(a_, t_begin, t_end) * range_of(b_, t_begin, t_end);
  }
  Law integral(double t0) const override {
    return make_quadrature_integral(Law{std::make_shared<Product>(a_, b_)}, t0);
  }

 private:
  Law a_;
  Law b_;
};

/// f = g'.
class Rate final : public Node {
 public:
  explicit Rate(Law law) : law_(std::move(law)) {}

  LawValue at(double t, Side side) const override {
    const double ahead = (side == Side::right ? 1e-6 : -1e-6) * std::max(1.0, std::abs(t));
    const LawValue g = law_.at(t, side), beside = law_.at(t + ahead, side);
    return {g.rate, g.acceleration, (beside.acceleration - g.acceleration) / ahead};
  }
  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    laws::append_breaks(law_, t_begin, t_end, max_order == any_order ? any_order : max_order + 1, breaks);
  }
  Jet<Interval> range(double t_begin, double t_end) const override {
    const Jet<Interval> g = range_of(law_, t_begin, t_end);
    return {g.rate, g.acceleration, everything()};
  }
  Law integral(double t0) const override { return make_quadrature_integral(Law{std::make_shared<Rate>(law_)}, t0); }

 private:
  Law law_;
};

/// The law of the last segment that has begun. order: lowest derivative that may jump at a start.
class Piecewise final : public Node {
 public:
  Piecewise(std::vector<Segment> segments, int order) : segments_(std::move(segments)), order_(order) {}

  LawValue at(double t, Side side) const override { return segments_[segment_of(t, side)].law.at(t, side); }

  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    for (std::size_t i = segment_of(t_begin, Side::left); i < segments_.size(); ++i) {
      const double start = segments_[i].start;
      if (i > 0 && start > t_end) break;
      if (i > 0 && order_ <= max_order && start >= t_begin) breaks.add(start);
      const double from = i == 0 ? t_begin : std::max(t_begin, start);
      const double to = i + 1 == segments_.size() ? t_end : std::min(t_end, segments_[i + 1].start);
      if (from <= to) laws::append_breaks(segments_[i].law, from, to, max_order, breaks);
    }
  }

  Jet<Interval> range(double t_begin, double t_end) const override {
    const std::size_t first = segment_of(t_begin, Side::left), last = segment_of(t_end, Side::right);
    const auto of = [&](std::size_t i) {
      return range_of(segments_[i].law, i == first ? t_begin : std::max(t_begin, segments_[i].start),
                      i == last ? t_end : std::min(t_end, segments_[i + 1].start));
    };
    Jet<Interval> all = of(first);
    for (std::size_t i = first + 1; i <= last; ++i) {
      const Jet<Interval> next = of(i);
      all = {hull(all.value, next.value), hull(all.rate, next.rate), hull(all.acceleration, next.acceleration)};
    }
    return all;
  }

  /// Integrates from the segment that holds t0 outwards; each segment continues the value of its neighbour at their
  /// common start.
  Law integral(double t0) const override {
    std::vector<Segment> result = segments_;
    const std::size_t home = segment_of(t0, Side::right);
    result[home].law = segments_[home].law.integral(t0);
    for (std::size_t i = home + 1; i < result.size(); ++i) {
      const double t = result[i].start;
      const double value = result[i - 1].law.at(t, Side::left).value;
      result[i].law = make_sum({segments_[i].law.integral(t), make_constant_unchecked(value)});
    }
    for (std::size_t i = home; i-- > 0;) {
      const double t = result[i + 1].start;
      const double value = result[i + 1].law.at(t, Side::right).value;
      result[i].law = make_sum({segments_[i].law.integral(t), make_constant_unchecked(value)});
    }
    return Law{std::make_shared<Piecewise>(std::move(result), order_ + 1)};
  }

 private:
  /// The value at a start may be infinite (a pole). It is reported when the law is evaluated, not here.
  static Law make_constant_unchecked(double value) {
    return Law{std::make_shared<PolynomialPieces>(std::vector<PolynomialPieces::Knot>{},
                                                  std::vector<PolynomialPieces::Piece>{{0.0, 1.0, {value}}})};
  }

  std::size_t segment_of(double t, Side side) const {
    const auto has_begun = [t, side](const Segment& segment) {
      return side == Side::right ? segment.start <= t : segment.start < t;
    };
    const auto next = std::partition_point(segments_.begin() + 1, segments_.end(), has_begun);
    return static_cast<std::size_t>(next - segments_.begin()) - 1;
  }

  std::vector<Segment> segments_;
  int order_;
};

}  // namespace

Law make_sum(const std::vector<Law>& terms) {
  std::vector<Term> kept;
  double level = 0.0;  // all constant terms together, so that a sum of constants is one
  for (const Law& law : terms) {
    if (law.is_constant()) {
      level += law.at(0.0).value;
    } else {
      kept.push_back({1.0, law});
    }
  }
  const Law constant{std::make_shared<PolynomialPieces>(std::vector<PolynomialPieces::Knot>{},
                                                        std::vector<PolynomialPieces::Piece>{{0.0, 1.0, {level}}})};
  if (kept.empty()) return constant;
  if (level != 0.0) kept.push_back({1.0, constant});
  if (kept.size() == 1) return kept.front().law;
  return Law{std::make_shared<LinearCombination>(std::move(kept))};
}

Law make_scaled(double factor, const Law& law) {
  require_finite(factor, "the factor of a law");
  if (factor == 0.0) return Law{};
  if (law.is_constant()) return make_constant(factor * law.at(0.0).value);
  return Law{std::make_shared<LinearCombination>(std::vector<Term>{{factor, law}})};
}

Law make_product(const Law& a, const Law& b) {
  if (a.is_constant()) return make_scaled(a.at(0.0).value, b);
  if (b.is_constant()) return make_scaled(b.at(0.0).value, a);
  return Law{std::make_shared<Product>(a, b)};
}

Law make_piecewise(const std::vector<Segment>& segments) {
  if (segments.empty()) throw LawError({}, 0, "a piecewise law needs at least one segment");
  for (std::size_t i = 0; i < segments.size(); ++i) {
    require_finite(segments[i].start, "the start of a segment");
    if (i > 0 && !(segments[i - 1].start < segments[i].start)) {
      throw LawError({}, 0, "the starts of segments must increase: segment " + std::to_string(i) + " does not");
    }
  }
  if (segments.size() == 1) return segments.front().law;
  return Law{std::make_shared<Piecewise>(segments, 0)};
}

Law make_cycloidal(double t0, double t1, double v0, double v1) {
  const Law ramp = make_ramp(t0, t1, v0, v1);  // checks the data
  if (v0 == v1) return ramp;
  const double two_pi = 2.0 * std::numbers::pi;
  const Law wave = make_wave({-(v1 - v0) / two_pi, two_pi / (t1 - t0), 0.0, 0.0, t0});
  const Law line{std::make_shared<PolynomialPieces>(
      std::vector<PolynomialPieces::Knot>{}, std::vector<PolynomialPieces::Piece>{{t0, t1 - t0, {v0, v1 - v0}}})};
  std::vector<Segment> segments{{t0 - 1.0, make_constant(v0)}, {t0, make_sum({line, wave})}, {t1, make_constant(v1)}};
  return Law{std::make_shared<Piecewise>(std::move(segments), 3)};
}

Law make_rate(const Law& law) { return law.is_constant() ? make_constant(0.0) : Law{std::make_shared<Rate>(law)}; }

}  // namespace bough::laws
