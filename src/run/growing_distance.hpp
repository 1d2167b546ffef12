#pragma once
#include <optional>
#include <span>
#include <vector>

#include "extrapolation.hpp"

namespace bough::run {

struct Sensitivity {
  double grows_in = 0.0;            ///< time in which the distance of members grows by e [s]
  std::optional<double> lost_from;  ///< time from which on they are as far apart as the motion is wide [s]
};

/// Distance of the two finest members over time, in parts of the ranges of columns: the largest of all columns so far. An
/// error that adds up grows as a power of time, t^4 at the most; where it grows by more than that while time doubles,
/// the motion is sensitive and it grows as e^(t / T).
class GrowingDistance {
 public:
  void add(const MemberDifferences& d, double range);
  std::optional<Sensitivity> look(std::span<const double> times) const;

 private:
  std::vector<double> distance_;
};

}  // namespace bough::run
