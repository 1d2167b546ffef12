#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "bough/laws/law.hpp"
#include "jet.hpp"

namespace bough::laws {

/// Collects breakpoints in any order, possibly twice, up to a limit.
struct BreakList {
  std::vector<double> times;
  std::size_t most = std::numeric_limits<std::size_t>::max();
  bool is_cut = false;  ///< there are more breakpoints, or the search was given up
  double work = 0.0;    ///< number of formula instructions executed by the search

  bool is_limited() const { return most != std::numeric_limits<std::size_t>::max(); }
  void add(double t) {
    if (times.size() < most)
      times.push_back(t);
    else
      is_cut = true;
  }
};

/// One kind of law: the implementation behind Law. Immutable; all members may run on several threads at once.
class Node {
 public:
  Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  virtual ~Node() = default;

  virtual LawValue at(double t, Side side) const = 0;

  /// Appends the times in [t_begin, t_end] at which a derivative of order <= max_order may jump (order 0: the value),
  /// in any order, possibly twice. 2 serves Law::breakpoints, any_order the quadrature.
  virtual void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const = 0;

  virtual Law integral(double t0) const = 0;

  /// Bounds of value, rate and acceleration over [t_begin, t_end], those of all branches met there.
  virtual Jet<Interval> range(double t_begin, double t_end) const = 0;
  virtual bool is_constant() const { return false; }
  virtual std::optional<Law> integrand() const { return std::nullopt; }  ///< of an integral by quadrature
};

inline constexpr int any_order = 1 << 20;

/// Throws LawError(what) where x is not finite.
void require_finite(double x, const char* what);

/// Breaks of a law, sorted and unique.
Breaks sorted_breaks(const Law& law, double t_begin, double t_end, int max_order,
                     std::size_t most = std::numeric_limits<std::size_t>::max());

/// Node::range of the node behind a law.
Jet<Interval> range_of(const Law& law, double t_begin, double t_end);

/// Node::append_breaks of the node behind a law.
void append_breaks(const Law& law, double t_begin, double t_end, int max_order, BreakList& breaks);

}  // namespace bough::laws
