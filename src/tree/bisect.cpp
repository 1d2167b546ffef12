#include "bisect.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "bough/blocks/at.hpp"
#include "bough/tree/tree.hpp"
#include "quotient.hpp"

namespace bough::tree {

namespace {

/// Number of separators that are compared by predicted cost. Small sets are frequent and matter little.
constexpr int most_trials = 8, few_trials = 3, small_set = 200;

}  // namespace

Bisector::Bisector(const Adjacency& adjacency, unsigned seed)
    : adjacency_(adjacency),
      seed_(seed),
      weight_(at(adjacency.graph->num_elements())),
      touches_(at(adjacency.graph->num_blocks()), 0),
      position_(at(adjacency.graph->num_elements()), -1),
      spread_(at(adjacency.graph->num_blocks()), 0),
      removed_(at(adjacency.graph->num_blocks()), 0),
      local_(at(adjacency.graph->num_blocks()), -1),
      side_touches_(at(adjacency.graph->num_blocks()), 0) {
  for (int e = 0; e < adjacency.graph->num_elements(); ++e) {
    const double n = adjacency.unknowns_of(e);
    weight_[at(e)] = std::max(1.0, n * n);
  }
}

bool Bisector::connects(int block) const {
  return touches_[at(block)] > 1 && touches_[at(block)] == adjacency_.degree(block) && !removed_[at(block)];
}

void Bisector::load(const std::vector<int>& elements) {
  for (int b : loaded_) touches_[at(b)] = 0;
  loaded_.clear();
  for (int e : elements)
    for (int b : adjacency_.blocks_of(e))
      if (touches_[at(b)]++ == 0) loaded_.push_back(b);
}

Bisector::Pieces Bisector::find_pieces(const std::vector<int>& elements) const {
  for (std::size_t i = 0; i < elements.size(); ++i) position_[at(elements[i])] = static_cast<int>(i);
  Pieces pieces;
  pieces.of_element.assign(elements.size(), -1);
  std::vector<int> stack;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (pieces.of_element[i] >= 0) continue;
    const int piece = pieces.count++;
    double weight = 0.0;
    stack.assign(1, static_cast<int>(i));
    pieces.of_element[i] = piece;
    while (!stack.empty()) {
      const int e = elements[at(stack.back())];
      stack.pop_back();
      weight += weight_of(e);
      for (int b : adjacency_.blocks_of(e)) {
        if (!connects(b) || spread_[at(b)]) continue;
        spread_[at(b)] = 1;  // once, or a hub would cost the square of its arms
        for (int other : adjacency_.elements_of(b)) {
          const int j = position_[at(other)];
          if (pieces.of_element[at(j)] >= 0) continue;
          pieces.of_element[at(j)] = piece;
          stack.push_back(j);
        }
      }
    }
    pieces.weight.push_back(weight);
  }
  for (int e : elements) {
    position_[at(e)] = -1;
    for (int b : adjacency_.blocks_of(e)) spread_[at(b)] = 0;
  }
  return pieces;
}

bool Bisector::piece_is_tree(const std::vector<int>& elements, const Pieces& pieces, int piece) const {
  // A connected graph is a tree if and only if edges = vertices - 1. Each connecting block has touches_ edges and is
  // one vertex.
  double edges = 0.0, vertices = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (pieces.of_element[i] != piece) continue;
    vertices += 1.0;
    for (int b : adjacency_.blocks_of(elements[i])) {
      if (!connects(b)) continue;
      edges += 1.0;
      vertices += 1.0 / touches_[at(b)];
    }
  }
  return edges < vertices - 0.5;
}

bool Bisector::is_forest(const std::vector<int>& elements) {
  load(elements);
  const Pieces pieces = find_pieces(elements);
  double edges = 0.0, vertices = static_cast<double>(elements.size());
  for (int b : loaded_)
    if (connects(b)) {
      edges += touches_[at(b)];
      vertices += 1.0;
    }
  return edges < vertices - pieces.count + 0.5;
}

int Bisector::centroid_block(const std::vector<int>& elements, const Pieces& pieces, int piece) {
  // Weight below every vertex of the tree (elements weigh, blocks do not), rooted at the piece's first element; then
  // for every block the heaviest part that its removal leaves.
  struct Step {
    int element, parent_block;
  };
  std::vector<Step> order;
  const double total = pieces.weight[at(piece)];
  for (std::size_t i = 0; i < elements.size() && order.empty(); ++i)
    if (pieces.of_element[i] == piece) order.push_back({elements[i], -1});
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Step s = order[k];
    for (int b : adjacency_.blocks_of(s.element)) {
      if (b == s.parent_block || !connects(b)) continue;
      for (int other : adjacency_.elements_of(b))
        if (other != s.element) order.push_back({other, b});
    }
  }
  std::vector<double> below(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position_[at(order[k].element)] = static_cast<int>(k);
  for (std::size_t k = order.size(); k-- > 0;) {
    const Step s = order[k];
    below[k] = weight_of(s.element);
    for (int b : adjacency_.blocks_of(s.element)) {
      if (b == s.parent_block || !connects(b)) continue;
      for (int other : adjacency_.elements_of(b))
        if (other != s.element) below[k] += below[at(position_[at(other)])];
    }
  }
  int best = -1;
  double best_score = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (int b : adjacency_.blocks_of(order[k].element)) {
      if (b == order[k].parent_block || !connects(b)) continue;
      double sum = 0.0, most = 0.0;
      for (int other : adjacency_.elements_of(b)) {
        if (other == order[k].element) continue;
        const double w = below[at(position_[at(other)])];
        sum += w;
        most = std::max(most, w);
      }
      most = std::max(most, total - sum);
      // Balance decides first, but halving the size of the block may be worth a tenth of imbalance.
      const double score = most / total + 0.02 * adjacency_.size_of(b);
      if (best < 0 || score < best_score - 1e-12 || (score < best_score + 1e-12 && b < best)) {
        best = b;
        best_score = score;
      }
    }
  }
  for (const Step& s : order) position_[at(s.element)] = -1;
  return best;
}

/// What the separator of a cut and those of its two sides will cost: E(s, b) flops for s unknowns to eliminate and b
/// on the boundary. The separators of the sides are not known yet: as a guess smaller by the ratio of the weights to
/// the power 1/2.
double Bisector::predict_flops(const std::vector<int>& elements, const std::vector<std::uint8_t>& sides) {
  double weight[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    weight[sides[i]] += weight_of(elements[i]);
    if (sides[i] == 0)
      for (int b : adjacency_.blocks_of(elements[i])) ++side_touches_[at(b)];
  }
  int separator = 0, boundary = 0, held[2] = {0, 0};
  for (int b : loaded_) {
    const int size = adjacency_.size_of(b), degree = adjacency_.degree(b);
    const int touches[2] = {side_touches_[at(b)], touches_[at(b)] - side_touches_[at(b)]};
    side_touches_[at(b)] = 0;
    const bool is_inside = touches[0] == degree || touches[1] == degree;
    if (touches_[at(b)] != degree)
      boundary += size;
    else if (!is_inside)
      separator += size;
    for (int k : {0, 1})
      if (touches[k] > 0 && touches[k] < degree) held[k] += size;
  }
  double sides_flops = 0.0;
  for (int k : {0, 1}) {
    const double next = separator * std::sqrt(weight[k] / (weight[0] + weight[1]));
    sides_flops += elimination_flops(static_cast<int>(next), held[k]);
  }
  return elimination_flops(separator, boundary) + sides_flops;
}

/// Vertices: connecting blocks of the piece; a joint's multipliers (one element each) weigh on its first connecting
/// block.
Bisector::PieceGraph Bisector::graph_of(const std::vector<int>& elements, const Pieces& pieces, int piece) {
  PieceGraph g;
  g.element_begin.assign(1, 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    int first = -1, extra = 0;
    const bool is_in = pieces.of_element[i] == piece;
    for (int b : is_in ? adjacency_.blocks_of(elements[i]) : std::span<const int>()) {
      if (!connects(b)) {
        extra += adjacency_.is_motion(b) ? 0 : adjacency_.size_of(b);
        continue;
      }
      int& vertex = local_[at(b)];
      if (vertex < 0) {
        vertex = static_cast<int>(g.blocks.size());
        g.blocks.push_back(b);
        g.graph.weights.push_back(adjacency_.size_of(b));
      }
      if (first < 0) first = vertex;
      g.element_vertices.push_back(vertex);
    }
    if (first >= 0) g.graph.weights[at(first)] += extra;
    g.element_begin.push_back(static_cast<int>(g.element_vertices.size()));
  }
  std::vector<int> met(g.blocks.size(), -1);
  std::vector<int>& columns = g.graph.columns;
  g.graph.row_begin.assign(1, 0);
  for (std::size_t v = 0; v < g.blocks.size(); ++v) {
    met[v] = static_cast<int>(v);
    for (int e : adjacency_.elements_of(g.blocks[v]))
      for (int b : adjacency_.blocks_of(e)) {
        const int w = local_[at(b)];
        if (w < 0 || met[at(w)] == static_cast<int>(v)) continue;
        met[at(w)] = static_cast<int>(v);
        columns.push_back(w);
      }
    std::sort(columns.begin() + g.graph.row_begin.back(), columns.end());
    g.graph.row_begin.push_back(static_cast<int>(columns.size()));
  }
  for (int b : g.blocks) local_[at(b)] = -1;
  return g;
}

/// The pieces that are left of the set once the vertices of part 2, the separator, connect nothing.
Bisector::Pieces Bisector::find_pieces_beside(const std::vector<int>& part, const PieceGraph& graph,
                                              const std::vector<int>& elements, const Pieces& before, int piece) const {
  std::vector<int> component(part.size(), -1), stack;
  int components = 0;
  for (std::size_t start = 0; start < part.size(); ++start) {
    if (part[start] == 2 || component[start] >= 0) continue;
    component[start] = components;
    stack.assign(1, static_cast<int>(start));
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      for (int c = graph.graph.row_begin[at(v)]; c < graph.graph.row_begin[at(v) + 1]; ++c) {
        const int w = graph.graph.columns[at(c)];
        if (part[at(w)] == 2 || component[at(w)] >= 0) continue;
        component[at(w)] = components;
        stack.push_back(w);
      }
    }
    ++components;
  }
  Pieces pieces;  // numbered by their first elements
  pieces.of_element.resize(elements.size());
  std::vector<int> of_component(at(components), -1), of_other(at(before.count), -1);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    int alone = -1;  // an element whose connecting blocks are all in the separator
    int* number = before.of_element[i] == piece ? &alone : &of_other[at(before.of_element[i])];
    for (int k = graph.element_begin[i]; k < graph.element_begin[i + 1]; ++k)
      if (const int c = component[at(graph.element_vertices[at(k)])]; c >= 0) {
        number = &of_component[at(c)];
        break;
      }
    if (*number < 0) {
      *number = pieces.count++;
      pieces.weight.push_back(0.0);
    }
    pieces.of_element[i] = *number;
    pieces.weight[at(*number)] += weight_of(elements[i]);
  }
  return pieces;
}

Cut Bisector::cut_by_separator(const std::vector<int>& elements, const Pieces& pieces, int piece) {
  used_separator_ = true;
  const PieceGraph graph = graph_of(elements, pieces, piece);
  std::vector<std::uint8_t> best;
  double least = 0.0;
  const int trials = static_cast<int>(graph.blocks.size()) < small_set ? few_trials : most_trials;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<int> part = separate_vertices(graph.graph, seed_ + static_cast<unsigned>(trial));
    std::vector<std::uint8_t> sides = choose_sides(find_pieces_beside(part, graph, elements, pieces, piece));
    const double flops = predict_flops(elements, sides);
    if (trial > 0 && !(flops < least)) continue;
    least = flops;
    best = std::move(sides);
  }
  return deal_out(elements, best);
}

Cut Bisector::cut(const std::vector<int>& elements) {
  load(elements);
  Pieces pieces = find_pieces(elements);
  const double total = std::accumulate(pieces.weight.begin(), pieces.weight.end(), 0.0);
  const int largest =
      static_cast<int>(std::max_element(pieces.weight.begin(), pieces.weight.end()) - pieces.weight.begin());
  if (pieces.weight[at(largest)] > total * (2.0 / 3.0)) {
    if (piece_is_tree(elements, pieces, largest)) {
      const int block = centroid_block(elements, pieces, largest);
      if (block >= 0) {
        removed_[at(block)] = 1;
        pieces = find_pieces(elements);
        removed_[at(block)] = 0;
      }
    } else {
      return cut_by_separator(elements, pieces, largest);
    }
  }
  return deal_out(elements, choose_sides(pieces));
}

std::vector<std::uint8_t> Bisector::choose_sides(const Pieces& pieces) const {
  std::vector<int> order(at(pieces.count));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return pieces.weight[at(a)] > pieces.weight[at(b)]; });
  std::vector<std::uint8_t> side_of(at(pieces.count), 0);
  double load[2] = {0.0, 0.0};
  for (int p : order) {
    const std::uint8_t side{load[1] < load[0]};
    side_of[at(p)] = side;
    load[side] += pieces.weight[at(p)];
  }
  std::vector<std::uint8_t> sides(pieces.of_element.size(), 0);
  if (pieces.count > 1)
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = side_of[at(pieces.of_element[i])];
  else  // there is no separator: any two halves are a valid cut of the elements
    std::fill(sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2), sides.end(), std::uint8_t{1});
  return sides;
}

Cut Bisector::deal_out(const std::vector<int>& elements, const std::vector<std::uint8_t>& sides) {
  Cut result;
  for (std::size_t i = 0; i < elements.size(); ++i) result.side[sides[i]].push_back(elements[i]);
  return result;
}

}  // namespace bough::tree
