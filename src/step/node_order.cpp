#include "bough/step/node_order.hpp"

namespace bough::step {

NodeOrder::NodeOrder(const plan::Plan& plan, const solve::SolverVisits& visits) : places_(plan.nodes.size()) {
  std::vector<std::vector<int>> nodes(static_cast<std::size_t>(visits.count() + 1));  // those without unknowns last
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const int block = plan.block_of_node[n];
    nodes[static_cast<std::size_t>(block < 0 ? visits.count() : visits.of_block[static_cast<std::size_t>(block)])]
        .push_back(static_cast<int>(n));
  }
  std::vector<int> of_eight;
  for (int v = 0; v <= visits.count(); ++v) {
    const std::vector<int>& own = nodes[static_cast<std::size_t>(v)];
    for (std::size_t first = 0; first < own.size(); first += 8) {
      NodeEight eight;
      eight.count = static_cast<int>(std::min<std::size_t>(8, own.size() - first));
      for (int l = 0; l < 8; ++l) {
        const std::size_t k = first + static_cast<std::size_t>(std::min(l, eight.count - 1));
        eight.node[static_cast<std::size_t>(l)] = own[k];
        places_[static_cast<std::size_t>(own[k])] = {eights_.size(), std::min(l, eight.count - 1),
                                                     1 + (l - std::min(l, eight.count - 1))};
      }
      eight.is_run = eight.count == 8 && eight.node[7] == eight.node[0] + 7;
      eights_.push_back(eight);
      of_eight.push_back(v);
    }
  }
  by_visit_ = VisitRanges(of_eight, visits.count());
}

}  // namespace bough::step
