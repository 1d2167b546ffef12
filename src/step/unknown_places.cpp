#include "bough/step/unknown_places.hpp"

#include "bough/elements/rows.hpp"

namespace bough::step {

UnknownPlaces::UnknownPlaces(const plan::Plan& plan, const std::vector<std::int64_t>& unknown_begin)
    : plan_(plan), block_begin_(unknown_begin) {
  for (const int block : plan.block_of_node) node_begin_.push_back(block < 0 ? -1 : block_begin(block));
  for (const plan::SignalPlan& s : plan::driving_signals(plan))
    signals_.push_back(static_cast<std::size_t>(block_begin(s.block)));
  const std::vector<elements::Joint>& joints = plan::array_of<elements::Joint>(plan.elements);
  for (const plan::JointPlan& joint : plan.joints) {
    if (joint.block < 0) continue;
    const plan::ElementPlace place = plan.directory[static_cast<std::size_t>(joint.element)];
    const elements::Joint& e = joints[static_cast<std::size_t>(place.index)];
    const auto multiplier = static_cast<std::size_t>(joint.multiplier_begin);
    auto unknown = static_cast<std::size_t>(block_begin(joint.block));
    for (const int row : joint.rows)
      multipliers_.push_back(
          {multiplier + static_cast<std::size_t>(row), unknown++, elements::is_length(e.rows[row].kind)});
  }
}

}  // namespace bough::step
