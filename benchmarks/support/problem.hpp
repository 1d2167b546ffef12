#pragma once
/// One linear system in two forms: element matrices over a block graph for bough, compressed sparse columns for its
/// peers.
#include <cstdint>
#include <string>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/scene/scene.hpp"
#include "bough/solve/sparse_columns.hpp"

namespace bough::bench {

using SparseMatrix = solve::SparseColumns;

enum class Values { unsymmetric, symmetric };

struct Problem {
  std::string name;
  Values values = Values::unsymmetric;
  bool is_definite = false;  ///< symmetric and positive definite
  bool is_scaled = true;     ///< the diagonal is near one, so that no solver needs scaling
  blocks::BlockGraph graph;
  std::vector<std::vector<double>> elements;  ///< row-major, by element; empty where the matrix came from a file
  std::vector<int> unknown_begin;             ///< by block
  std::vector<int> place;  ///< where the graph has an unknown of the matrix; empty: in the same place
  SparseMatrix matrix;     ///< all entries without exact zeros (an entry and its mirror are omitted together)
  std::vector<double> rhs;
  bool is_symmetric() const { return values == Values::symmetric; }
};

/// The tangent of a time step of 1e-3 s (spectral radius 0.8) of a scene whose nodes have small random displacements,
/// rotations and velocities (fixed seed), so that no entry vanishes by chance.
///   symmetric: the symmetric part of each element matrix, constraint rows included.
/// Unknowns and rows are measured in units of powers of two that bring the diagonal (of multipliers: the largest
/// entry of the row) near one, so that no solver needs scaling. The right-hand side is random in [-1, 1].
Problem make_problem(const std::string& name, const scene::Scene& scene, Values values);

/// The problem of element matrices over a graph, row-major by element: scaled and assembled as above, right-hand side
/// random.
Problem make_problem(const std::string& name, const blocks::BlockGraph& graph,
                     std::vector<std::vector<double>> elements, Values values);

/// Normwise backward error max_i |b - A x|_i / (|A|_inf |x|_inf + |b|_inf); NaN if x is not finite.
double eval_backward_error(const SparseMatrix& a, const std::vector<double>& x, const std::vector<double>& b);

/// Lower triangle with the diagonal.
SparseMatrix lower_triangle(const SparseMatrix& a);
/// P A P^T: row i of the result is row order[i] of a.
SparseMatrix permute(const SparseMatrix& a, const std::vector<int>& order);

/// Elimination orders found on the graph of blocks. "node amd" or "node metis" (empty if METIS was not found): a joint's
/// multipliers are merged into the first node it constrains and eliminated right after it, so that no pivot is zero.
/// "node bough": the order of bough's tree. order[i]: i-th unknown of the matrix to eliminate.
std::vector<int> order_nodes(const Problem& problem, const std::string& method);

}  // namespace bough::bench
