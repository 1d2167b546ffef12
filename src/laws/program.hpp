#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bough::laws {

enum class Op : std::uint8_t {
  number,
  time,
  variable,
  negate,
  add,
  subtract,
  multiply,
  divide,
  pow_number,
  pow_general,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  sqrt,
  abs,
  sign,
  step,
  min,
  max  // these change branch where their argument (min, max: the difference) changes sign
};

/// is_switch: the operation has branches; switch_order: the lowest derivative that jumps where the branch changes.
constexpr bool is_switch(Op op) { return op >= Op::abs; }
constexpr int switch_order(Op op) { return op == Op::sign || op == Op::step ? 0 : 1; }
constexpr bool has_two_arguments(Op op) {
  return (op >= Op::add && op <= Op::divide) || op == Op::pow_general || op == Op::min || op == Op::max;
}

struct Instruction {
  Op op = Op::number;
  double number = 0.0;      ///< the number; the exponent of pow_number
  std::uint32_t first = 0;  ///< of a switch: where the instructions of its arguments begin; of a variable: its index
};

/// A formula in postfix order: each instruction takes its arguments from a stack and leaves its result there.
struct Program {
  std::vector<Instruction> code;
  bool has_switch = false;
};

/// Greatest height of the stack; the parser refuses formulas that need more.
inline constexpr int max_stack = 256;
inline constexpr int max_nesting = 64;

/// Reads a formula; constant parts are evaluated at once. Throws LawError (make_expression says when).
/// variables: names that stand for numbers given when the program runs, beside t, pi, e.
Program parse_formula(const std::string& text, std::span<const std::string> variables = {});

}  // namespace bough::laws
