#include "bough/laws/law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/laws/bounds.hpp"
#include "bough/laws/law_error.hpp"
#include "node.hpp"

namespace bough::laws {

LawValue Law::at(double t, Side side) const { return node_ ? node_->at(t, side) : LawValue{}; }

std::vector<double> Law::breakpoints(double t_begin, double t_end) const {
  return sorted_breaks(*this, t_begin, t_end, 2).times;
}

Breaks Law::breakpoints(double t_begin, double t_end, std::size_t most) const {
  return sorted_breaks(*this, t_begin, t_end, 2, most);
}

double largest_acceleration(const Law& law, double t_begin, double t_end) {
  const Interval a = range_of(law, t_begin, t_end).acceleration;
  const double most = std::max(std::abs(a.lo), std::abs(a.hi));
  return std::isnan(most) ? std::numeric_limits<double>::infinity() : most;
}

std::optional<Law> Law::integrand() const { return node_ ? node_->integrand() : std::nullopt; }

Law Law::integral(double t0) const { return node_ ? node_->integral(t0) : Law{}; }

bool Law::is_constant() const { return !node_ || node_->is_constant(); }

std::optional<std::string> non_finite(const LawValue& law_value) {
  std::string names;
  const auto check = [&names](double x, const char* name) {
    if (std::isfinite(x)) return;
    if (!names.empty()) names += ", ";
    names += std::string(name) + " is " + (std::isnan(x) ? "not a number" : "infinite");
  };
  check(law_value.value, "value");
  check(law_value.rate, "rate");
  check(law_value.acceleration, "acceleration");
  if (names.empty()) return std::nullopt;
  return names;
}

void require_finite(double x, const char* what) {
  if (!std::isfinite(x)) throw LawError({}, 0, std::string(what) + " must be a finite number");
}

Jet<Interval> range_of(const Law& law, double t_begin, double t_end) {
  return law.node() != nullptr ? law.node()->range(t_begin, t_end) : Jet<Interval>{};
}

void append_breaks(const Law& law, double t_begin, double t_end, int max_order, BreakList& breaks) {
  if (law.node() != nullptr && max_order >= 0 && !breaks.is_cut)
    law.node()->append_breaks(t_begin, t_end, max_order, breaks);
}

Breaks sorted_breaks(const Law& law, double t_begin, double t_end, int max_order, std::size_t most) {
  BreakList list;
  list.most = most;
  append_breaks(law, t_begin, t_end, max_order, list);
  Breaks breaks{std::move(list.times), list.is_cut, list.work};
  std::sort(breaks.times.begin(), breaks.times.end());
  breaks.times.erase(std::unique(breaks.times.begin(), breaks.times.end()), breaks.times.end());
  return breaks;
}

}  // namespace bough::laws
