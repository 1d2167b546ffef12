#pragma once
/// One cut of a set of elements into two. Internal to tree.
#include <cstdint>
#include <vector>

#include "adjacency.hpp"

namespace bough::tree {

/// A graph in compressed rows.
struct VertexGraph {
  std::vector<int> row_begin, columns, weights;
};

struct Cut {
  std::vector<int> side[2];  ///< element ids, in the order they were given.
};

/// Algorithm and work space for cutting a set of elements. The set is treated as a bipartite graph of elements and
/// *interior* blocks (those whose elements are all in the set). Blocks on the boundary are shared in any case and
/// connect nothing.
class Bisector {
 public:
  Bisector(const Adjacency& adjacency, unsigned seed);

  /// True if the bipartite graph of the set has no cycle. A sweep from its ends then causes no fill, and dissection is
  /// not needed.
  bool is_forest(const std::vector<int>& elements);

  /// Divides a set of at least two elements into two non-empty sides. Unconnected pieces are distributed over the
  /// sides, the largest first. If one piece holds more than two thirds of the weight, it is split first: a tree at one
  /// block (its centroid), any other graph at the vertex separator of least predicted cost among several.
  Cut cut(const std::vector<int>& elements);

  bool used_separator() const { return used_separator_; }

 private:
  struct Pieces {
    int count = 0;
    std::vector<int> of_element;  ///< by position in the set
    std::vector<double> weight;
  };
  /// One piece of a set as the graph of its connecting blocks, which are neighbours if an element holds both.
  struct PieceGraph {
    std::vector<int> blocks;  ///< by vertex
    VertexGraph graph;
    std::vector<int> element_begin, element_vertices;  ///< vertices of each element of the set; other pieces: none
  };
  void load(const std::vector<int>& elements);
  Pieces find_pieces(const std::vector<int>& elements) const;
  bool piece_is_tree(const std::vector<int>& elements, const Pieces& pieces, int piece) const;
  int centroid_block(const std::vector<int>& elements, const Pieces& pieces, int piece);
  PieceGraph graph_of(const std::vector<int>& elements, const Pieces& pieces, int piece);
  Pieces find_pieces_beside(const std::vector<int>& part, const PieceGraph& graph, const std::vector<int>& elements,
                            const Pieces& before, int piece) const;
  Cut cut_by_separator(const std::vector<int>& elements, const Pieces& pieces, int piece);
  /// Side 0 or 1 of each element: pieces are distributed by weight, the largest first.
  std::vector<std::uint8_t> choose_sides(const Pieces& pieces) const;
  static Cut deal_out(const std::vector<int>& elements, const std::vector<std::uint8_t>& sides);
  double predict_flops(const std::vector<int>& elements, const std::vector<std::uint8_t>& sides);
  double weight_of(int element) const { return weight_[static_cast<std::size_t>(element)]; }
  bool connects(int block) const;

  const Adjacency& adjacency_;
  unsigned seed_;
  bool used_separator_ = false;
  std::vector<double> weight_;         ///< by element: unknowns squared, a measure of assembly and evaluation
  std::vector<int> touches_;           ///< by block: elements of the loaded set that hold it
  std::vector<int> loaded_;            ///< blocks with touches_ > 0
  mutable std::vector<int> position_;  ///< by element: position in the present set, or -1 (scratch)
  mutable std::vector<char> spread_;   ///< by block: find_pieces has gone on to its elements (scratch)
  std::vector<char> removed_;          ///< by block: separator of the present cut
  std::vector<int> local_;             ///< by block: vertex number in a separator graph, or -1
  std::vector<int> side_touches_;      ///< by block: elements of the first side that hold it (scratch)
};

/// Vertex separator of a graph: part 0, 1, or 2 (the separator) of each vertex. Uses METIS if it was built in and the
/// graph is large enough, otherwise breadth-first levels from a far vertex, which do not depend on the seed.
std::vector<int> separate_vertices(const VertexGraph& graph, unsigned seed);

}  // namespace bough::tree
