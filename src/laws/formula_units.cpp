/// What is known of the value of a formula before its variables have values.
#include <charconv>
#include <cmath>
#include <vector>

#include "bough/laws/formula.hpp"
#include "program.hpp"

namespace bough::laws {
namespace {

/// A power of a unit. number: a number in the formula, in whatever unit it is meant. A pure number has power 0.
struct Dimension {
  enum class Kind { number, power_of_unit, unknown };
  Kind kind = Kind::unknown;
  std::string unit;
  double power = 0.0;

  bool is_pure() const { return kind == Kind::power_of_unit && power == 0.0; }
  bool is_number() const { return kind == Kind::number; }
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

const Dimension unknown, number{Dimension::Kind::number, {}, 0.0}, pure{Dimension::Kind::power_of_unit, {}, 0.0};

Dimension power_of(const std::string& unit, double power) {
  return power == 0.0 || unit.empty() ? pure : Dimension{Dimension::Kind::power_of_unit, unit, power};
}

Dimension raised(const Dimension& a, double power) {
  return a.kind == Dimension::Kind::power_of_unit ? power_of(a.unit, power * a.power) : a;
}

/// The sides of a sum have one unit, and a number takes it from the others.
Dimension sum(const Dimension& a, const Dimension& b) {
  if (a.is_number()) return b;
  if (b.is_number() || a == b) return a;
  return unknown;
}

/// A number beside a unit may have a unit itself, as in 9.81*m.
Dimension product(const Dimension& a, const Dimension& b) {
  if (a.is_pure()) return b;
  if (b.is_pure() || (a.is_number() && b.is_number())) return a;
  const bool are_units = a.kind == Dimension::Kind::power_of_unit && b.kind == a.kind;
  return are_units && a.unit == b.unit ? power_of(a.unit, a.power + b.power) : unknown;
}

Dimension of_two(Op op, const Dimension& a, const Dimension& b) {
  switch (op) {
    case Op::multiply:
      return product(a, b);
    case Op::divide:
      return product(a, raised(b, -1.0));
    case Op::pow_general: {
      const bool are_numbers = (a.is_pure() || a.is_number()) && (b.is_pure() || b.is_number());
      return are_numbers ? a : unknown;
    }
    default:
      return sum(a, b);
  }
}

Dimension of_one(const Instruction& instruction, const Dimension& a) {
  switch (instruction.op) {
    case Op::negate:
    case Op::abs:
      return a;
    case Op::pow_number:
      return raised(a, instruction.number);
    case Op::sqrt:
      return raised(a, 0.5);
    case Op::asin:
    case Op::acos:
    case Op::atan:
      return power_of("rad", 1.0);
    default:
      return pure;
  }
}

std::optional<std::string> text_of(const Dimension& d) {
  if (d.kind != Dimension::Kind::power_of_unit) return std::nullopt;
  if (d.power == 0.0) return std::string();
  if (d.power == 1.0) return d.unit;
  char digits[32];
  const auto [end, status] = std::to_chars(digits, digits + sizeof digits, d.power);
  const bool is_compound = d.unit.find_first_of(" /^") != std::string::npos;
  return (is_compound ? "(" + d.unit + ")" : d.unit) + "^" + std::string(digits, end);
}

/// Whether a value is 0 or 1 whatever the variables are; whether it is the number 1.
struct Truth {
  bool is_either = false, is_one = false;
};

Truth of_two(Op op, const Truth& a, const Truth& b) {
  if (op == Op::subtract) return {a.is_one && b.is_either};
  const bool keeps = op == Op::multiply || op == Op::min || op == Op::max;
  return {keeps && a.is_either && b.is_either};
}

Truth of_one(const Instruction& instruction, const Truth& a) {
  if (instruction.op == Op::step) return {true};
  const bool keeps = instruction.op == Op::abs || instruction.op == Op::sqrt ||
                     (instruction.op == Op::pow_number && instruction.number > 0.0);
  return {keeps && a.is_either};
}

/// Runs the program on a stack of what is known of values. leaf: of a number or a variable.
template <class T, class Leaf>
T known_of(const Program& program, const Leaf& leaf) {
  std::vector<T> stack;
  for (const Instruction& instruction : program.code) {
    if (instruction.op == Op::number || instruction.op == Op::variable || instruction.op == Op::time) {
      stack.push_back(leaf(instruction));
    } else if (has_two_arguments(instruction.op)) {
      const T second = stack.back();
      stack.pop_back();
      stack.back() = of_two(instruction.op, stack.back(), second);
    } else {
      stack.back() = of_one(instruction, stack.back());
    }
  }
  return stack.back();
}

}  // namespace

std::optional<std::string> Formula::unit_if_known(std::span<const std::optional<std::string>> units) const {
  return text_of(known_of<Dimension>(*program_, [&](const Instruction& i) {
    return i.op == Op::variable && units[i.first] ? power_of(*units[i.first], 1.0) : number;
  }));
}

std::string Formula::unit(std::span<const std::string> units) const {
  const std::vector<std::optional<std::string>> known(units.begin(), units.end());
  return unit_if_known(known).value_or("");
}

bool Formula::is_zero_or_one() const {
  return known_of<Truth>(
             *program_,
             [](const Instruction& i) {
               const bool is_number = i.op == Op::number;
               return Truth{is_number && (i.number == 0.0 || i.number == 1.0), is_number && i.number == 1.0};
             })
      .is_either;
}

}  // namespace bough::laws
