#include "bough/step/round_off.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "element_parts.hpp"
#include "node_size.hpp"

namespace bough::step {

RoundOff::RoundOff(const plan::Plan& plan, const UnknownPlaces& places, const LinearSolution& linear,
                   const ElementEvaluation& elements, const ElementLengths& lengths)
    : plan_(plan),
      places_(places),
      linear_(linear),
      elements_(elements),
      lengths_(lengths),
      is_length_(places.size(), 0),
      sums_(places.size()) {
  for (int b = 0; b < places.num_blocks(); ++b)
    if (linear.owners().node(b) >= 0)
      for (int i = 0; i < places.block_size(b); ++i)
        is_length_[static_cast<std::size_t>(places.block_begin(b) + i)] = plan.unknowns.is_length(i);
  unknowns_.reserve(most_unknowns);
}

const ResidualSize& RoundOff::floor() const {
  return estimate(floor_, [](std::size_t) { return true; });
}

const ResidualSize& RoundOff::of_poses() const {
  return estimate(of_poses_, [this](std::size_t element) {
    bool is_between = false;
    plan::with_element(plan_.elements, plan_.directory[element],
                       [&](const auto& e) { is_between = std::decay_t<decltype(e)>::num_ports > 1; });
    return is_between;
  });
}

template <class Counts>
const ResidualSize& RoundOff::estimate(Estimate& known, Counts&& counts) const {
  if (known.matrices == linear_.num_matrices()) return known.size;
  known.matrices = linear_.num_matrices();
  constexpr double eps = std::numeric_limits<double>::epsilon();
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    if (!counts(e)) continue;
    const solve::ConstElementView K = elements_.matrix_of(static_cast<int>(e), unknowns_);
    const plan::JointPlan* const joint = plan_.joint_of(e);
    const std::size_t n = unknowns_.size(), rows = (joint == nullptr || joint->block < 0 ? 0 : joint->rows.size()) +
                                                   plan::signals_of(plan_, e).size();
    const std::size_t node_columns = n - rows;  // which come first
    for (std::size_t row = 0; row < n; ++row) {
      if (unknowns_[row] < 0) continue;
      double sum = 0.0;
      for (std::size_t col = 0; col < node_columns; ++col)
        if (unknowns_[col] >= 0)
          sum += std::abs(K[static_cast<std::int64_t>(row * n + col)]) *
                 (is_length_[static_cast<std::size_t>(unknowns_[col])] ? lengths_.of_element[e] : 1.0);
      sums_[static_cast<std::size_t>(unknowns_[row])] += eps * sum;
    }
  }
  ResidualSize& size = known.size = {};
  for (int b = 0; b < places_.num_blocks(); ++b) {
    if (linear_.owners().node(b) < 0) continue;
    const auto node = static_cast<std::size_t>(linear_.owners().node(b));
    const NodeSize of_node = size_up(plan_.unknowns, node, sums_.data() + places_.block_begin(b));
    size.force = std::max(size.force, of_node.force);
    size.moment = std::max(size.moment, of_node.moment);
  }
  size.length = 8.0 * eps * plan_.length_scale;
  size.angle = 8.0 * eps;
  return size;
}

}  // namespace bough::step
