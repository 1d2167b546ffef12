// The law of a formula: derivatives by Taylor arithmetic, changes of branch by interval arithmetic.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "eval_program.hpp"
#include "node.hpp"
#include "polynomial_pieces.hpp"
#include "program.hpp"
#include "quadrature.hpp"
#include "traps_masked.hpp"

namespace bough::laws {

namespace {

/// Finds the times at which one switch of a formula changes branch: the roots of its argument g.
///   0 not in g([a, b])                     no root: drop
///   0 not in g'([a, b])                    g monotone, at most one root: bisect g
///   0 not in g''([a, b])                   one extremum: bisect g' for it, then g on both sides
///   else                                   halve [a, b]
class SwitchFinder {
 public:
  SwitchFinder(const Program& program, std::size_t index, BreakList& found)
      : program_(program),
        index_(index),
        found_(found),
        length_(static_cast<double>(index - program.code[index].first)) {}

  void search(double t_begin, double t_end) {
    std::vector<Interval> boxes{{t_begin, t_end}};
    const double least = 1e-14 * (t_end - t_begin);
    std::vector<Interval> unsettled;
    const int max_work = found_.is_limited() ? limited_work : whole_work;
    for (int work = 0; !boxes.empty() && !found_.is_cut; ++work) {
      const Interval box = boxes.back();
      boxes.pop_back();
      if (settle(box)) continue;
      const double middle = 0.5 * (box.lo + box.hi);
      const bool is_smallest = !(box.hi - box.lo > least) || !(middle > box.lo && middle < box.hi);
      if (found_.is_limited() && (work >= max_work || found_.work > limited_instructions)) {
        found_.is_cut = true;
      } else if (is_smallest || work >= max_work || unsettled.size() > max_unsettled) {
        unsettled.push_back(box);
      } else {
        boxes.push_back({middle, box.hi});
        boxes.push_back({box.lo, middle});
      }
    }
    // A few boxes without a verdict hold roots of higher order or jumps of g. Many mean that g is round-off around
    // zero, and so are its changes of sign.
    if (unsettled.size() <= max_unsettled)
      for (const Interval& box : unsettled) cross(box.lo, box.hi);
  }

 private:
  static constexpr int whole_work = 1 << 20;    // boxes; a root needs a handful
  static constexpr int limited_work = 1 << 17;  // for the first thousands of roots, or to see that g is round-off
  static constexpr double limited_instructions = 5e7;  // of a whole formula: half a second
  static constexpr std::size_t max_unsettled = 1000;

  double argument(double t) const { return jet(t).value; }
  double argument_rate(double t) const { return jet(t).rate; }
  Jet<double> jet(double t) const {
    found_.work += length_;
    return eval_switch_argument(program_, index_, t);
  }

  /// True if all roots in the box have been found.
  bool settle(const Interval& box) {
    found_.work += 4.0 * length_;  // intervals, with their ends
    const Jet<Interval> g = eval_switch_range(program_, index_, box);
    if (!g.value.holds_zero()) return true;
    if (g.value.lo >= 0.0 || g.value.hi <= 0.0) {  // g touches zero at most; a sign change can only be at an end
      offer(box.lo);
      offer(box.hi);
      return true;
    }
    if (!g.rate.holds_zero()) {
      cross(box.lo, box.hi);
      return true;
    }
    if (!g.acceleration.holds_zero()) {
      const double extremum = first_change([this](double t) { return argument_rate(t); }, box.lo, box.hi);
      cross(box.lo, extremum);
      cross(extremum, box.hi);
      return true;
    }
    return false;
  }

  /// First double after a, found by bisection, at which the sign differs from the sign at a; b where it does not
  /// change.
  template <class F>
  static double first_change(const F& f, double a, double b) {
    const int sign_a = sign_of(f(a));
    if (sign_of(f(b)) == sign_a) return b;
    for (;;) {
      const double middle = 0.5 * a + 0.5 * b;
      if (!(middle > a && middle < b) || b - a < tiny_time) return b;
      (sign_of(f(middle)) == sign_a ? a : b) = middle;
    }
  }

  void cross(double a, double b) {
    const int sign_a = sign_of(argument(a));
    if (sign_a == 0) offer(a);
    if (sign_a != sign_of(argument(b))) {
      offer(sign_a == 0 ? b : first_change([this](double t) { return argument(t); }, a, b));
    }
  }

  /// Records t if the evaluation of the formula takes different branches on its two sides.
  void offer(double t) {
    if (std::abs(t) < tiny_time) t = 0.0;
    if (eval_branch(program_, index_, t, Side::left) != eval_branch(program_, index_, t, Side::right)) {
      found_.add(t);
    }
  }

  const Program& program_;
  std::size_t index_;
  BreakList& found_;
  double length_;  ///< instructions of the argument
};

class Expression final : public Node {
 public:
  explicit Expression(Program program) : program_(std::make_shared<const Program>(std::move(program))) {}
  explicit Expression(std::shared_ptr<const Program> program) : program_(std::move(program)) {}

  LawValue at(double t, Side side) const override {
    const TrapsMasked traps_masked;  // a derivative that is infinite may not be wanted: x^1.5 at 0 as a force
    const Jet<double> f = eval_program(*program_, t, side);
    return {f.value, f.rate, f.acceleration};
  }

  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    if (!program_->has_switch || !(t_begin <= t_end)) return;
    const TrapsMasked traps_masked;
    BreakList found;
    found.most = breaks.most;
    // The search starts one double earlier, so that a root exactly at t_begin is seen as a change of sign.
    const double from = previous_time(t_begin);
    for (std::size_t i = 0; i < program_->code.size(); ++i) {
      const Op op = program_->code[i].op;
      if (is_switch(op) && switch_order(op) <= max_order && !found.is_cut)
        SwitchFinder(*program_, i, found).search(from, t_end);
    }
    for (double t : found.times) {
      if (t >= t_begin && t <= t_end) breaks.add(t);
    }
    breaks.is_cut = breaks.is_cut || found.is_cut;
    breaks.work += found.work;
  }

  Jet<Interval> range(double t_begin, double t_end) const override {
    const TrapsMasked traps_masked;
    return eval_range(*program_, {t_begin, t_end});
  }
  Law integral(double t0) const override {
    return make_quadrature_integral(Law{std::make_shared<Expression>(program_)}, t0);
  }

 private:
  std::shared_ptr<const Program> program_;
};

}  // namespace

Law make_expression(const std::string& text) {
  Program program = parse_formula(text);
  if (program.code.size() == 1 && program.code[0].op == Op::number) {
    return Law{
        std::make_shared<PolynomialPieces>(std::vector<PolynomialPieces::Knot>{},
                                           std::vector<PolynomialPieces::Piece>{{0.0, 1.0, {program.code[0].number}}})};
  }
  return Law{std::make_shared<Expression>(std::move(program))};
}

}  // namespace bough::laws
