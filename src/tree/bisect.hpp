#pragma once
/// One cut of a set of elements into two. Internal to tree.
#include <vector>

#include "adjacency.hpp"

namespace bough::tree {

struct Cut {
  std::vector<int> side[2];  ///< element ids, in the order they were given.
};

/// Scratch and rules of cutting. The set is seen as a bipartite graph of elements and *interior* blocks (all of whose
/// elements are in the set): blocks on the boundary are shared anyway and connect nothing.
class Bisector {
 public:
  Bisector(const Adjacency& adjacency, unsigned seed);

  /// True if the bipartite graph of the set has no cycle: then a sweep from the ends fills nothing and needs no
  /// dissection.
  bool is_forest(const std::vector<int>& elements);

  /// True if the set is one chain: every element joins at most two motion blocks, every block at most two others, and
  /// no loop is closed.
  bool is_path(const std::vector<int>& elements);

  /// Two non-empty sides (precondition: at least two elements). Unconnected pieces are dealt out, the largest first;
  /// a piece above two thirds of the weight is cut before: a tree exactly at one block (centroid), others at the
  /// vertex separator of least predicted cost among several.
  Cut cut(const std::vector<int>& elements);

  bool used_separator() const { return used_separator_; }

 private:
  struct Pieces {
    int count = 0;
    std::vector<int> of_element;  ///< by position in the set
    std::vector<double> weight;
  };
  void load(const std::vector<int>& elements);
  Pieces find_pieces(const std::vector<int>& elements) const;
  bool piece_is_tree(const std::vector<int>& elements, const Pieces& pieces, int piece) const;
  int centroid_block(const std::vector<int>& elements, const Pieces& pieces, int piece);
  Cut cut_by_separator(const std::vector<int>& elements, const Pieces& pieces, int piece);
  Cut deal_out(const std::vector<int>& elements, const Pieces& pieces) const;
  double predict_flops(const Cut& cut);
  double weight_of(int element) const { return weight_[static_cast<std::size_t>(element)]; }
  bool connects(int block) const;

  const Adjacency& adjacency_;
  unsigned seed_;
  bool used_separator_ = false;
  std::vector<double> weight_;         ///< by element: unknowns squared, a measure of assembly and evaluation
  std::vector<int> touches_;           ///< by block: elements of the loaded set that hold it
  std::vector<int> loaded_;            ///< blocks with touches_ > 0
  mutable std::vector<int> position_;  ///< by element: position in the set at hand, or -1 (scratch)
  std::vector<char> removed_;          ///< by block: separator of the present cut
  std::vector<int> local_;             ///< by block: vertex number in a separator graph, or -1
  std::vector<int> side_touches_;      ///< by block: elements of the side at hand that hold it (scratch)
};

/// A graph in compressed rows.
struct VertexGraph {
  std::vector<int> row_begin, columns, weights;
};

/// Vertex separator of a graph: part 0, 1, or 2 (the separator). METIS where it was built in and the graph is large
/// enough, otherwise breadth-first levels from a far vertex, whatever the seed.
std::vector<int> separate_vertices(const VertexGraph& graph, unsigned seed);

}  // namespace bough::tree
