#include "eval_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace bough::laws {

namespace {

/// Sign of a quantity just after (direction 1) or just before (-1) the time of its jet: the first term that is not
/// zero.
int sign_beside(const Jet<double>& x, int direction) {
  if (x.value != 0.0) return sign_of(x.value);
  if (x.rate != 0.0) return direction * sign_of(x.rate);
  return sign_of(x.acceleration);
}

/// Sign of the switch argument as seen from one side. before: the argument at the last time before t, used for the
/// left. A root between two doubles thus has different signs on the two sides of the upper one.
int branch_of(const Jet<double>& argument, const Jet<double>* before) {
  if (before == nullptr) return sign_beside(argument, 1);
  return before->value != 0.0 ? sign_of(before->value) : sign_beside(argument, -1);
}

template <class S>
Jet<S> number_jet(double x) {
  return {S(x), S(0.0), S(0.0)};
}

/// 1 / cosh(x) without overflow.
double sech(double x) {
  const double decay = std::exp(-std::abs(x));
  return 2.0 * decay / (1.0 + decay * decay);
}
Interval sech(const Interval& x) { return Interval(1.0) / cosh(x); }

template <class S>
Jet<S> eval_smooth(Op op, const Jet<S>& x) {
  using std::acos, std::asin, std::atan, std::cos, std::cosh, std::exp, std::log, std::sin, std::sinh, std::sqrt;
  using std::tan, std::tanh;
  const S& v = x.value;
  const S one(1.0);
  switch (op) {
    case Op::negate:
      return -x;
    case Op::sin: {
      const S f = sin(v);
      return chain(x, f, S(cos(v)), -f);
    }
    case Op::cos: {
      const S f = cos(v);
      return chain(x, f, -S(sin(v)), -f);
    }
    case Op::tan: {
      const S f = tan(v);
      const S df = one + f * f;
      return chain(x, f, df, S(2.0) * f * df);
    }
    case Op::asin: {
      const S square = (one - v) * (one + v);
      const S df = one / S(sqrt(square));
      return chain(x, S(asin(v)), df, v * df / square);
    }
    case Op::acos: {
      const S square = (one - v) * (one + v);
      const S df = -(one / S(sqrt(square)));
      return chain(x, S(acos(v)), df, v * df / square);
    }
    case Op::atan: {
      const S df = one / (one + v * v);
      return chain(x, S(atan(v)), df, -(S(2.0) * v * df * df));
    }
    case Op::sinh: {
      const S f = sinh(v);
      return chain(x, f, S(cosh(v)), f);
    }
    case Op::cosh: {
      const S f = cosh(v);
      return chain(x, f, S(sinh(v)), f);
    }
    case Op::tanh: {
      const S f = tanh(v);
      const S g = sech(v);
      const S df = g * g;  // 1 - f^2 without cancellation
      return chain(x, f, df, -(S(2.0) * f * df));
    }
    case Op::exp: {
      const S f = exp(v);
      return chain(x, f, f, f);
    }
    case Op::log: {
      const S df = one / v;
      return chain(x, S(log(v)), df, -(df * df));
    }
    case Op::sqrt: {
      const S f = sqrt(v);
      const S df = S(0.5) / f;
      return chain(x, f, df, -(S(0.5) * df / v));
    }
    default:
      return x;
  }
}

template <class S>
Jet<S> eval_two(Op op, const Jet<S>& a, const Jet<S>& b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    default:
      return pow_general(a, b);
  }
}

Jet<double> not_a_number() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, nan};
}

/// Switches on numbers: one branch is taken, by its sign (-1, 0, 1). NaN stays NaN.
Jet<double> eval_switch(Op op, int branch, const Jet<double>& a, const Jet<double>& b) {
  if (std::isnan(a.value) || std::isnan(b.value)) return not_a_number();
  switch (op) {
    case Op::abs:
      return branch < 0 ? -a : a;
    case Op::sign:
      return number_jet<double>(branch);
    case Op::step:
      return number_jet<double>(branch < 0 ? 0.0 : 1.0);
    case Op::min:
      return branch < 0 ? a : b;
    default:
      return branch < 0 ? b : a;
  }
}

Jet<Interval> hull(const Jet<Interval>& a, const Jet<Interval>& b, bool is_jump) {
  // At a kink the acceleration has no bound, at a jump the rate has none.
  return {laws::hull(a.value, b.value), is_jump ? everything() : laws::hull(a.rate, b.rate), everything()};
}

/// Switches on ranges: the hull of both branches where the sign of the argument is not known.
Jet<Interval> eval_switch(Op op, const Interval& sign, const Jet<Interval>& a, const Jet<Interval>& b) {
  const bool may_be_low = !(sign.lo > 0.0);
  const bool may_be_high = !(sign.hi < 0.0);
  Jet<Interval> low = a;
  Jet<Interval> high = b;
  if (op == Op::abs) low = -a, high = a;
  if (op == Op::sign) low = number_jet<Interval>(-1.0), high = number_jet<Interval>(1.0);
  if (op == Op::step) low = number_jet<Interval>(0.0), high = number_jet<Interval>(1.0);
  if (op == Op::max) low = b, high = a;
  if (!may_be_low) return high;
  if (!may_be_high) return low;
  Jet<Interval> both = hull(low, high, switch_order(op) == 0);
  if (op == Op::abs && both.value.lo < 0.0) both.value.lo = 0.0;
  if (op == Op::min) both.value.hi = a.value.hi < b.value.hi ? a.value.hi : b.value.hi;
  if (op == Op::max) both.value.lo = a.value.lo > b.value.lo ? a.value.lo : b.value.lo;
  return both;
}

template <class S>
using Stack = std::array<Jet<S>, max_stack>;

/// The variables of a formula. They move if `motions` are given; else they are constant, but for one that grows with
/// rate 1 if there is a `growing` one.
struct Variables {
  const double* values = nullptr;
  std::size_t growing = static_cast<std::size_t>(-1);
  const LawValue* motions = nullptr;
  Jet<double> operator[](std::size_t i) const {
    if (motions != nullptr) return {motions[i].value, motions[i].rate, motions[i].acceleration};
    return {values[i], i == growing ? 1.0 : 0.0, 0.0};
  }
};

/// One instruction on one stack. branch: of a switch, for numbers.
template <class S>
void apply(const Instruction& instruction, int branch, const Jet<S>& t, Stack<S>& stack, std::size_t height,
           const Variables& variables = {}) {
  // height: of the stack before the instruction
  const Op op = instruction.op;
  if (op == Op::number) {
    stack[height] = number_jet<S>(instruction.number);
  } else if (op == Op::time) {
    stack[height] = t;
  } else if (op == Op::variable) {
    if constexpr (std::is_same_v<S, double>) stack[height] = variables[instruction.first];
  } else if (has_two_arguments(op)) {
    Jet<S>& a = stack[height - 2];
    const Jet<S>& b = stack[height - 1];
    if (!is_switch(op)) {
      a = eval_two(op, a, b);
    } else if constexpr (std::is_same_v<S, double>) {
      a = eval_switch(op, branch, a, b);
    } else {
      a = eval_switch(op, (a - b).value, a, b);
    }
  } else {
    Jet<S>& a = stack[height - 1];
    if (op == Op::pow_number) {
      a = pow_number(a, instruction.number);
    } else if (!is_switch(op)) {
      a = eval_smooth(op, a);
    } else if constexpr (std::is_same_v<S, double>) {
      a = eval_switch(op, branch, a, a);
    } else {
      a = eval_switch(op, a.value, a, a);
    }
  }
}

/// The argument that decides the branch of a switch, taken from the stack just before the switch.
template <class S>
Jet<S> switch_argument(Op op, const Stack<S>& stack, std::size_t height) {
  if (has_two_arguments(op)) return stack[height - 2] - stack[height - 1];
  return stack[height - 1];
}

/// Runs instructions [begin, end) from an empty stack at time jet t. Returns the height of the stack. before: null, or
/// the stack of a run at the last time before t, which this run advances as well to find the branches seen from the
/// left.
template <class S>
std::size_t run(const Program& program, std::size_t begin, std::size_t end, const Jet<S>& t, Stack<S>& stack,
                const Jet<double>* t_before = nullptr, Stack<double>* before = nullptr,
                const Variables& variables = {}) {
  std::size_t height = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const Instruction& instruction = program.code[i];
    const Op op = instruction.op;
    int branch = 0;
    if constexpr (std::is_same_v<S, double>) {
      if (before != nullptr) {
        Jet<double> argument_before{};
        if (is_switch(op)) argument_before = switch_argument(op, *before, height);
        if (is_switch(op)) branch = branch_of(switch_argument(op, stack, height), &argument_before);
        apply(instruction, branch_of(argument_before, nullptr), *t_before, *before, height);
      } else if (is_switch(op)) {
        branch = branch_of(switch_argument(op, stack, height), nullptr);
      }
    }
    apply(instruction, branch, t, stack, height, variables);
    if (op == Op::number || op == Op::time || op == Op::variable) ++height;
    if (has_two_arguments(op)) --height;
  }
  return height;
}

Jet<double> time_jet(double t) { return {t, 1.0, 0.0}; }

}  // namespace

double previous_time(double t) {
  return std::min(std::nextafter(t, -std::numeric_limits<double>::infinity()), t - tiny_time);
}

double eval_program(const Program& program, std::span<const double> variables) {
  Stack<double> stack;
  run(program, 0, program.code.size(), number_jet<double>(0.0), stack, nullptr, nullptr, {variables.data()});
  return stack[0].value;
}

double eval_slope(const Program& program, std::span<const double> variables, std::size_t by) {
  Stack<double> stack;
  run(program, 0, program.code.size(), number_jet<double>(0.0), stack, nullptr, nullptr, {variables.data(), by});
  return stack[0].rate;
}

Jet<double> eval_along(const Program& program, std::span<const LawValue> variables) {
  Stack<double> stack;
  Variables moving;
  moving.motions = variables.data();
  run(program, 0, program.code.size(), number_jet<double>(0.0), stack, nullptr, nullptr, moving);
  return stack[0];
}

Jet<double> eval_program(const Program& program, double t, Side side) {
  Stack<double> stack;
  if (side == Side::right || !program.has_switch) {
    run(program, 0, program.code.size(), time_jet(t), stack);
    return stack[0];
  }
  Stack<double> before;
  const Jet<double> t_before = time_jet(previous_time(t));
  run(program, 0, program.code.size(), time_jet(t), stack, &t_before, &before);
  return stack[0];
}

Jet<double> eval_switch_argument(const Program& program, std::size_t index, double t) {
  Stack<double> stack;
  const Instruction& instruction = program.code[index];
  const std::size_t height = run(program, instruction.first, index, time_jet(t), stack);
  return switch_argument(instruction.op, stack, height);
}

Jet<Interval> eval_switch_range(const Program& program, std::size_t index, const Interval& t) {
  Stack<Interval> stack;
  const Instruction& instruction = program.code[index];
  const Jet<Interval> time{t, Interval(1.0), Interval(0.0)};
  const std::size_t height = run(program, instruction.first, index, time, stack);
  return switch_argument(instruction.op, stack, height);
}

Jet<Interval> eval_range(const Program& program, const Interval& t) {
  Stack<Interval> stack;
  run(program, 0, program.code.size(), Jet<Interval>{t, Interval(1.0), Interval(0.0)}, stack);
  return stack[0];
}

int eval_branch(const Program& program, std::size_t index, double t, Side side) {
  if (side == Side::right) return sign_beside(eval_switch_argument(program, index, t), 1);
  const Instruction& instruction = program.code[index];
  Stack<double> stack;
  Stack<double> before;
  const Jet<double> t_before = time_jet(previous_time(t));
  const std::size_t height = run(program, instruction.first, index, time_jet(t), stack, &t_before, &before);
  const Jet<double> argument_before = switch_argument(instruction.op, before, height);
  return branch_of(switch_argument(instruction.op, stack, height), &argument_before);
}

}  // namespace bough::laws
