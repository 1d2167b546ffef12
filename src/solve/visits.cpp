#include "bough/solve/visits.hpp"

#include "bough/blocks/at.hpp"
#include "front_storage.hpp"
#include "lane_plan.hpp"

namespace bough::solve {

namespace {

void add_front(VisitShape& shape, int eliminated, int boundary) {
  ++shape.num_fronts;
  shape.flops += tree::elimination_flops(eliminated, boundary);
  shape.condense_flops += 2.0 * eliminated * boundary * boundary;
}

}  // namespace

VisitShapes make_visit_shapes(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options) {
  LanePlan plan = make_lane_plan(graph, tree, options.lanes, options.symmetry);
  VisitShapes shapes;
  for (const LaneGroup& group : plan.groups) {
    VisitShape shape{.subdomains = group.subdomains, .in_lanes = group.in_lanes};
    shape.batch_begin = group.element_begin;
    shape.batch_end = group.element_end;
    for (int b = group.element_begin; b < group.element_end; ++b) {
      const ElementBatch& batch = plan.batches[at(b)];
      std::int64_t n = 0;
      for (int e : batch.element) {
        if (e < 0) continue;
        n = 0;
        for (auto k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k)
          n += graph.block_size[at(graph.element_blocks[at(k)])];
      }
      shape.element_bytes += n * n * batch.stride * static_cast<std::int64_t>(sizeof(double));
    }
    if (group.in_lanes) {
      for (int f = group.front_begin; f < group.front_end; ++f) {
        const LaneFront& front = plan.fronts[at(f)];
        add_front(shape, front.eliminated, front.boundary);
        shape.factor_bytes += front.factor_size() * lanes_wide * static_cast<std::int64_t>(sizeof(double));
      }
    } else {
      const tree::Subdomain& s = tree.subdomains[at(group.subdomains.front())];
      for (tree::FrontId f = s.front_begin; f < s.front_end; ++f) {
        const tree::Front& front = tree.fronts[at(f)];
        add_front(shape, front.num_eliminated, front.num_boundary);
        shape.factor_bytes +=
            FrontShape(front.size(), front.num_eliminated, options.symmetry != Symmetry::general).factor_size() *
            static_cast<std::int64_t>(sizeof(double));
      }
    }
    shapes.visits.push_back(std::move(shape));
  }
  shapes.walk = std::move(plan.walk);
  return shapes;
}

}  // namespace bough::solve
