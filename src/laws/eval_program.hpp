#pragma once

#include <span>

#include "bough/laws/law.hpp"
#include "jet.hpp"
#include "program.hpp"

namespace bough::laws {

inline int sign_of(double x) { return x > 0.0 ? 1 : (x < 0.0 ? -1 : 0); }

/// In the search for changes of branch, times nearer to zero than this [s] count as zero: products of smaller ones
/// underflow and lose their sign.
inline constexpr double tiny_time = 1e-300;

/// The last time before t: the next double below, tiny_time below around zero.
double previous_time(double t);

/// Value and derivatives of a formula at t, at a change of branch from the given side. Pure: no allocation, no failure.
Jet<double> eval_program(const Program& program, double t, Side side);

/// Value of a formula of variables, which are taken as constant in time; t is 0.
double eval_program(const Program& program, std::span<const double> variables);
/// Its derivative by one of the variables.
double eval_slope(const Program& program, std::span<const double> variables, std::size_t by);

/// Value and derivatives in time of a formula of variables that move; a branch is the one that they enter.
Jet<double> eval_along(const Program& program, std::span<const LawValue> variables);

/// Argument that decides the branch of the switch at instruction `index`: zero where the branch changes.
Jet<double> eval_switch_argument(const Program& program, std::size_t index, double t);

/// Ranges of that argument and of its derivatives for all t of the interval.
Jet<Interval> eval_switch_range(const Program& program, std::size_t index, const Interval& t);

/// Ranges of a formula and of its derivatives for all t of the interval.
Jet<Interval> eval_range(const Program& program, const Interval& t);

/// Branch of the switch at instruction `index`, seen from one side of t: sign of the argument there, -1, 0 or 1.
int eval_branch(const Program& program, std::size_t index, double t, Side side);

}  // namespace bough::laws
