#include "bough/step/round_off.hpp"

#include <algorithm>
#include <array>
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
      is_length_(places.size(), 0) {
  for (int b = 0; b < places.num_blocks(); ++b)
    if (linear.owners().node(b) >= 0)
      for (int i = 0; i < places.block_size(b); ++i)
        is_length_[static_cast<std::size_t>(places.block_begin(b) + i)] = plan.unknowns.is_length(i);
  unknowns_.reserve(most_unknowns);
  for (Estimate* of : {&known_.of_all, &known_.of_poses}) of->sums.resize(places.size());
}

const RoundOff::Estimates& RoundOff::estimates() const {
  if (known_.matrices == linear_.num_matrices()) return known_;
  known_.matrices = linear_.num_matrices();
  for (Estimate* of : {&known_.of_all, &known_.of_poses}) of->sums.assign(places_.size(), 0.0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) add_element(e);
  for (Estimate* of : {&known_.of_all, &known_.of_poses}) take_sizes(*of);
  return known_;
}

void RoundOff::add_element(std::size_t element) const {
  const solve::ConstElementView K = elements_.matrix_of(static_cast<int>(element), unknowns_);
  const plan::JointPlan* const joint = plan_.joint_of(element);
  const std::size_t n = unknowns_.size(), rows = (joint == nullptr || joint->block < 0 ? 0 : joint->rows.size()) +
                                                 plan::signals_of(plan_, element).size();
  const std::size_t node_columns = n - rows;   // which come first
  std::array<double, most_unknowns> rounding;  // of coordinates
  for (std::size_t col = 0; col < node_columns; ++col)
    rounding[col] = is_length_[static_cast<std::size_t>(unknowns_[col])] ? lengths_.of_element[element] : 1.0;
  bool is_between = false;
  plan::with_element(plan_.elements, plan_.directory[element],
                     [&](const auto& e) { is_between = std::decay_t<decltype(e)>::num_ports > 1; });
  constexpr double eps = std::numeric_limits<double>::epsilon();
  for (std::size_t row = 0; row < n; ++row) {
    double sum = 0.0;
    for (std::size_t col = 0; col < node_columns; ++col)
      sum += std::abs(K[static_cast<std::int64_t>(row * n + col)]) * rounding[col];
    const auto unknown = static_cast<std::size_t>(unknowns_[row]);
    known_.of_all.sums[unknown] += eps * sum;
    if (is_between) known_.of_poses.sums[unknown] += eps * sum;
  }
}

void RoundOff::take_sizes(Estimate& of) const {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  of.size = {};
  for (int b = 0; b < places_.num_blocks(); ++b) {
    if (linear_.owners().node(b) < 0) continue;
    const auto node = static_cast<std::size_t>(linear_.owners().node(b));
    const NodeSize of_node = size_up(plan_.unknowns, node, of.sums.data() + places_.block_begin(b));
    of.size.force = std::max(of.size.force, of_node.force);
    of.size.moment = std::max(of.size.moment, of_node.moment);
  }
  of.size.length = 8.0 * eps * plan_.length_scale;
  of.size.angle = 8.0 * eps;
}

}  // namespace bough::step
