#include "profile_parts.hpp"

#include <algorithm>
#include <type_traits>

#include "bough/blocks/at.hpp"

namespace bough::study {

namespace {

std::array<double, 3> point_of(const motion::Vec3<double>& x) { return {x[0], x[1], x[2]}; }

/// Adds the position of a port, preceded by that of its node (once if both are equal).
void add_port(const plan::Plan& plan, const elements::Port& port, bool node_last,
              std::vector<std::array<double, 3>>& points) {
  const motion::Frame<double> node =
      port.node == elements::ground ? motion::Frame<double>::identity() : plan.nodes[at(port.node)].pose;
  std::vector<std::array<double, 3>> own;
  if (port.node != elements::ground) own.push_back(point_of(node.x));
  if (port.node == elements::ground || port.has_offset) own.push_back(point_of(node.x + node.R * port.offset.x));
  if (node_last) std::reverse(own.begin(), own.end());
  points.insert(points.end(), own.begin(), own.end());
}

template <class E>
void add_part(const plan::Plan& plan, const E& e, int leaf, records::Profile& out) {
  records::ProfilePart part{.kind = records::ProfilePart::Kind::joint, .leaf = leaf, .points = {}};
  if constexpr (E::role == elements::Role::beam) {
    part.kind = records::ProfilePart::Kind::beam;
    for (const elements::Port& port : e.ports) {
      std::vector<std::array<double, 3>> ends;
      add_port(plan, port, false, ends);
      part.points.push_back(ends.back());
    }
  } else if constexpr (E::role == elements::Role::body) {
    part.kind = records::ProfilePart::Kind::body;
    add_port(plan, e.ports[0], false, part.points);
  } else if constexpr (elements::joins_two_frames(E::role)) {
    add_port(plan, e.ports[0], false, part.points);
    add_port(plan, e.ports[1], true, part.points);
  } else {
    return;  // loads are not drawn
  }
  out.parts.push_back(std::move(part));
}

}  // namespace

std::vector<std::int64_t> count_matrix_entries(const blocks::BlockGraph& graph, const tree::Tree& tree) {
  std::vector<std::vector<int>> elements_of(at(graph.num_blocks()));
  for (int e = 0; e < graph.num_elements(); ++e)
    for (auto k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k)
      elements_of[at(graph.element_blocks[at(k)])].push_back(e);
  std::vector<std::int64_t> entries(at(tree.num_subdomains()), 0);
  std::vector<int> seen(at(graph.num_blocks()), -1);
  for (int b = 0; b < graph.num_blocks(); ++b) {
    const tree::FrontId front = tree.front_of_block[at(b)];
    std::int64_t& count = entries[at(tree.fronts[at(front)].subdomain)];
    const std::int64_t own = graph.block_size[at(b)];
    for (int e : elements_of[at(b)])
      for (auto k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k) {
        const int other = graph.element_blocks[at(k)];
        if (seen[at(other)] == b) continue;
        seen[at(other)] = b;
        const std::int64_t size = graph.block_size[at(other)];
        if (other == b) {
          count += own * own;
        } else if (tree.front_of_block[at(other)] > front || (tree.front_of_block[at(other)] == front && other > b)) {
          count += 2 * own * size;
        }
      }
  }
  return entries;
}

void draw_parts(const plan::Plan& plan, const tree::Tree& tree, records::Profile& out) {
  for (std::size_t e = 0; e < plan.directory.size(); ++e)
    plan::with_element(plan.elements, plan.directory[e],
                       [&](const auto& element) { add_part(plan, element, tree.leaf_of_element[e], out); });
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    if (plan.block_of_node[n] < 0) continue;  // held
    const tree::SubdomainId s = tree.fronts[at(tree.front_of_block[at(plan.block_of_node[n])])].subdomain;
    if (!tree.subdomains[at(s)].is_leaf()) out.separator_nodes.push_back({point_of(plan.nodes[n].pose.x), s});
  }
}

}  // namespace bough::study
