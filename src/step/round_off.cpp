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
                   const ElementLengths& lengths, const tree::Walker& walker)
    : plan_(plan),
      places_(places),
      linear_(linear),
      lengths_(lengths),
      walker_(walker),
      is_length_(places.size(), 0),
      sums_(places.size()) {
  for (int b = 0; b < places.num_blocks(); ++b)
    if (linear.owners().node(b) >= 0)
      for (int i = 0; i < places.block_size(b); ++i)
        is_length_[static_cast<std::size_t>(places.block_begin(b) + i)] = plan.unknowns.is_length(i);
  row_begin_.assign(1, 0);
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    std::int64_t end = row_begin_.back();
    for (auto k = plan.graph.element_begin[e]; k < plan.graph.element_begin[e + 1]; ++k)
      end += places.block_size(plan.graph.element_blocks[static_cast<std::size_t>(k)]);
    row_begin_.push_back(end);
  }
  rows_.assign(static_cast<std::size_t>(row_begin_.back()), 0.0);
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
  // Elements on the threads there are, then their sums in one order.
  const auto for_unknowns = [this](std::size_t e, auto&& visit) {
    for (auto k = plan_.graph.element_begin[e]; k < plan_.graph.element_begin[e + 1]; ++k) {
      const int b = plan_.graph.element_blocks[static_cast<std::size_t>(k)];
      for (int i = 0; i < places_.block_size(b); ++i) visit(static_cast<std::size_t>(places_.block_begin(b) + i));
    }
  };
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    std::array<double, most_unknowns> unit{};  // of an increment: the length of the element, or a radian
    for (auto e = static_cast<std::size_t>(begin); e < static_cast<std::size_t>(end); ++e) {
      if (!counts(e)) continue;
      const solve::ConstElementView K = linear_.solver().element(static_cast<int>(e));
      const plan::JointPlan* const joint = plan_.joint_of(e);
      const auto n = static_cast<std::size_t>(row_begin_[e + 1] - row_begin_[e]),
                 rows = (joint == nullptr || joint->block < 0 ? 0 : joint->rows.size()) +
                        plan::signals_of(plan_, e).size(),
                 node_columns = n - rows;  // which come first
      std::size_t column = 0;
      for_unknowns(e, [&](std::size_t u) { unit[column++] = is_length_[u] ? lengths_.of_element[e] : 1.0; });
      double* const sums = rows_.data() + row_begin_[e];
      for (std::size_t row = 0; row < n; ++row) {
        double sum = 0.0;
        for (std::size_t col = 0; col < node_columns; ++col)
          sum += std::abs(K[static_cast<std::int64_t>(row * n + col)]) * unit[col];
        sums[row] = eps * sum;
      }
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(plan_.directory.size()), element_grain,
                         tree::make_chunk(by_element));
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    if (!counts(e)) continue;
    const double* part = rows_.data() + row_begin_[e];
    for_unknowns(e, [&](std::size_t u) { sums_[u] += *part++; });
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
