#pragma once
/// A function of two numbers by a table: bilinear between the points of a grid.

#include <memory>
#include <span>
#include <vector>

#include "bough/laws/law.hpp"

namespace bough::laws {

/// With s = (x - x_i) / (x_{i+1} - x_i) and r alike of y, in the cell that holds (x, y),
///   f = (1 - s) (1 - r) f_ij + s (1 - r) f_{i+1,j} + (1 - s) r f_{i,j+1} + s r f_{i+1,j+1}
/// Outside of the grid f is that of its nearest point. An immutable value; copies share data.
class Surface {
 public:
  /// The number 0.
  Surface() = default;
  /// xs, ys: at least one each, strictly increasing; values: f_ij at i * ys.size() + j. Throws LawError where this is
  /// not so or a number is not finite.
  Surface(std::vector<double> xs, std::vector<double> ys, std::vector<double> values);
  /// Does not allocate.
  double operator()(double x, double y) const;
  /// The same, with its derivatives by x and y. On a line of the grid a derivative is that of the side on which its
  /// variable grows.
  double operator()(double x, double y, std::span<double, 2> slopes) const;
  /// Value, rate and acceleration along motions of x and y, within the cell that holds them.
  LawValue along(const LawValue& x, const LawValue& y) const;

 private:
  struct Grid;
  std::shared_ptr<const Grid> grid_;
};

}  // namespace bough::laws
