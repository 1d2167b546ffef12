#include "bisect.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
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
double Bisector::predict_flops(const Cut& cut) {
  double own = 0.0, sides = 0.0, weight[2] = {0.0, 0.0};
  int separator = 0, boundary = 0, held[2] = {0, 0};
  for (int b : loaded_) (touches_[at(b)] == adjacency_.degree(b) ? separator : boundary) += adjacency_.size_of(b);
  std::vector<int> touched;
  for (int k : {0, 1}) {
    touched.clear();
    for (int e : cut.side[k]) {
      weight[k] += weight_of(e);
      for (int b : adjacency_.blocks_of(e))
        if (side_touches_[at(b)]++ == 0) touched.push_back(b);
    }
    for (int b : touched) {
      const int size = adjacency_.size_of(b);
      if (side_touches_[at(b)] == adjacency_.degree(b)) {
        separator -= size;
      } else {
        held[k] += size;
      }
      side_touches_[at(b)] = 0;
    }
  }
  own = elimination_flops(separator, boundary);
  for (int k : {0, 1}) {
    const double next = separator * std::sqrt(weight[k] / (weight[0] + weight[1]));
    sides += elimination_flops(static_cast<int>(next), held[k]);
  }
  return own + sides;
}

Cut Bisector::cut_by_separator(const std::vector<int>& elements, const Pieces& pieces, int piece) {
  used_separator_ = true;
  // Vertices: connecting blocks of the piece; a joint's multipliers (one element each) weigh on its first connecting
  // block.
  std::vector<int> vertices, weights;
  std::vector<std::vector<int>> neighbours;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (pieces.of_element[i] != piece) continue;
    for (int b : adjacency_.blocks_of(elements[i])) {
      if (!connects(b) || local_[at(b)] >= 0) continue;
      local_[at(b)] = static_cast<int>(vertices.size());
      vertices.push_back(b);
      weights.push_back(adjacency_.size_of(b));
    }
  }
  neighbours.resize(vertices.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (pieces.of_element[i] != piece) continue;
    int first = -1, extra = 0;
    for (int b : adjacency_.blocks_of(elements[i])) {
      const int v = local_[at(b)];
      if (v < 0) {
        extra += adjacency_.is_motion(b) ? 0 : adjacency_.size_of(b);
        continue;
      }
      if (first < 0) first = v;
      for (int c : adjacency_.blocks_of(elements[i]))
        if (local_[at(c)] >= 0 && c != b) neighbours[at(v)].push_back(local_[at(c)]);
    }
    if (first >= 0) weights[at(first)] += extra;
  }
  VertexGraph graph;
  graph.row_begin.assign(1, 0);
  graph.weights = weights;
  for (auto& row : neighbours) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    graph.columns.insert(graph.columns.end(), row.begin(), row.end());
    graph.row_begin.push_back(static_cast<int>(graph.columns.size()));
  }
  for (int b : vertices) local_[at(b)] = -1;
  Cut best;
  double least = 0.0;
  const int trials = static_cast<int>(vertices.size()) < small_set ? few_trials : most_trials;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<int> part = separate_vertices(graph, seed_ + static_cast<unsigned>(trial));
    for (std::size_t v = 0; v < vertices.size(); ++v)
      if (part[v] == 2) removed_[at(vertices[v])] = 1;
    Cut cut = deal_out(elements, find_pieces(elements));
    for (int b : vertices) removed_[at(b)] = 0;
    const double flops = predict_flops(cut);
    if (trial > 0 && !(flops < least)) continue;
    least = flops;
    best = std::move(cut);
  }
  return best;
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
  return deal_out(elements, pieces);
}

Cut Bisector::deal_out(const std::vector<int>& elements, const Pieces& pieces) const {
  std::vector<int> order(at(pieces.count));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return pieces.weight[at(a)] > pieces.weight[at(b)]; });
  std::vector<int> side_of(at(pieces.count), 0);
  double load[2] = {0.0, 0.0};
  for (int p : order) {
    const int side = load[1] < load[0] ? 1 : 0;
    side_of[at(p)] = side;
    load[side] += pieces.weight[at(p)];
  }
  Cut result;
  for (std::size_t i = 0; i < elements.size(); ++i)
    result.side[side_of[at(pieces.of_element[i])]].push_back(elements[i]);
  if (result.side[0].empty() || result.side[1].empty()) {  // there is no separator: any two halves are a valid cut of
                                                           // the elements
    const auto half = static_cast<std::ptrdiff_t>(elements.size() / 2);
    result.side[0].assign(elements.begin(), elements.begin() + half);
    result.side[1].assign(elements.begin() + half, elements.end());
  }
  return result;
}

}  // namespace bough::tree
