#include "linkage.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "bough/plan/sets.hpp"

namespace bough::plan {

namespace {

/// Largest number of freedoms whose motions are computed by a decomposition.
constexpr std::size_t most_columns = 300;
constexpr std::size_t most_parts = 1000;

using Matrix = Eigen::MatrixXd;

/// Basis of the relative twists that the rows of an edge allow: 6 x (6 - rank).
Matrix freedoms_of(const LinkEdge& edge, const std::vector<Twist>& rows, double least_pivot) {
  if (rows.empty()) return Matrix::Identity(6, 6);
  if (edge.is_beam) return Matrix(6, 0);  // its rows are the unit vectors
  Matrix A(static_cast<Eigen::Index>(rows.size()), 6);
  for (std::size_t i = 0; i < rows.size(); ++i) A.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  Eigen::FullPivLU<Matrix> lu(A);
  lu.setThreshold(least_pivot);
  if (lu.rank() == 6) return Matrix(6, 0);
  return lu.kernel();
}

/// The spanning tree over which twists are summed, rooted at the ground if edges lead there.
struct SpanningTree {
  struct Step {
    int parent = -1, edge = -1;
    double sign = 1.0;  ///< -1: the edge leads from the part to its parent
    int depth = -1;
    int begin = 0;  ///< first of its freedoms within the component
    Matrix basis;   ///< of the relative twist
  };
  std::vector<Step> steps;  ///< by part
  std::vector<int> order;   ///< parts, parents first, without the ground
  std::vector<bool> is_closing;
};

SpanningTree make_spanning_tree(const std::vector<LinkEdge>& edges, std::size_t num_parts) {
  SpanningTree tree;
  tree.steps.resize(num_parts);
  tree.is_closing.assign(edges.size(), true);
  std::vector<std::vector<int>> at(num_parts);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const int part : {edges[e].first, edges[e].second})
      at[static_cast<std::size_t>(part)].push_back(static_cast<int>(e));
  std::vector<int> front;
  for (std::size_t top = 0; top < num_parts; ++top) {
    if (tree.steps[top].depth >= 0) continue;
    tree.steps[top].depth = 0;
    front.assign(1, static_cast<int>(top));
    for (std::size_t k = 0; k < front.size(); ++k) {
      if (front[k] != Linkage::ground) tree.order.push_back(front[k]);
      for (const int e : at[static_cast<std::size_t>(front[k])]) {
        const LinkEdge& edge = edges[static_cast<std::size_t>(e)];
        const int next = edge.first == front[k] ? edge.second : edge.first;
        SpanningTree::Step& step = tree.steps[static_cast<std::size_t>(next)];
        if (step.depth >= 0) continue;
        step.depth = tree.steps[static_cast<std::size_t>(front[k])].depth + 1;
        step.parent = front[k];
        step.edge = e;
        step.sign = edge.second == next ? 1.0 : -1.0;
        tree.is_closing[static_cast<std::size_t>(e)] = false;
        front.push_back(next);
      }
    }
  }
  return tree;
}

/// Adds factor * row . (twist of a part) as a function of the freedoms on the part's path to the root.
void add_way(const SpanningTree& tree, int part, const Twist& row, double factor, Eigen::Ref<Eigen::RowVectorXd> out) {
  for (int p = part; p > Linkage::ground; p = tree.steps[static_cast<std::size_t>(p)].parent) {
    const SpanningTree::Step& s = tree.steps[static_cast<std::size_t>(p)];
    out.segment(s.begin, s.basis.cols()) += factor * s.sign * row.transpose() * s.basis;
  }
}

}  // namespace

Twist Linkage::along(const Vec3d& direction, const Vec3d& x) const {
  const Vec3d arm = (1.0 / size_) * (x - center_), turn = lanes::cross(arm, direction);
  Twist row;
  row << direction[0], direction[1], direction[2], turn[0], turn[1], turn[2];
  return row;
}

Twist Linkage::about(const Vec3d& direction) {
  Twist row;
  row << 0.0, 0.0, 0.0, direction[0], direction[1], direction[2];
  return row;
}

std::vector<Twist> Linkage::rows_of(int edge, int relaxed) const {
  std::vector<Twist> rows = edges_[static_cast<std::size_t>(edge)].rows;
  if (edge == relaxed)
    rows.erase(std::remove_if(rows.begin(), rows.end(), [](const Twist& r) { return r.head<3>().isZero(0.0); }),
               rows.end());
  return rows;
}

int Linkage::num_rows(int edge, int relaxed) const {
  return static_cast<int>(edge == relaxed ? rows_of(edge, relaxed).size()
                                          : edges_[static_cast<std::size_t>(edge)].rows.size());
}

Twist LinkComponent::twist_of(int part, Eigen::Index motion) const {
  const auto known = place.find(part);
  return known == place.end() ? Twist(Twist::Zero()) : Twist(motions.block<6, 1>(6 * known->second, motion));
}

namespace {

/// What is left of a matrix without the freedoms (columns) that rows hold one after the other: a row in which one
/// freedom is left holds it. This takes linkages apart that hang on the ground like chains, so that the decomposition,
/// whose work is cubic, sees only loops of several freedoms.
struct Peeled {
  std::vector<Eigen::Index> rows, columns;
};

Peeled peel(const Matrix& A, double least_pivot) {
  std::vector<std::vector<Eigen::Index>> rows_of(static_cast<std::size_t>(A.cols()));
  std::vector<int> open(static_cast<std::size_t>(A.rows()), 0);  // free freedoms of a row
  const auto is_entry = [&](Eigen::Index i, Eigen::Index j) { return std::abs(A(i, j)) > least_pivot; };
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (is_entry(i, j)) {
        rows_of[static_cast<std::size_t>(j)].push_back(i);
        ++open[static_cast<std::size_t>(i)];
      }
  std::vector<char> is_held(rows_of.size(), 0);
  std::vector<Eigen::Index> single;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (open[static_cast<std::size_t>(i)] == 1) single.push_back(i);
  Peeled p;
  while (!single.empty()) {
    const Eigen::Index row = single.back();
    single.pop_back();
    if (open[static_cast<std::size_t>(row)] != 1) continue;
    Eigen::Index column = 0;
    while (is_held[static_cast<std::size_t>(column)] != 0 || !is_entry(row, column)) ++column;
    is_held[static_cast<std::size_t>(column)] = 1;
    for (const Eigen::Index i : rows_of[static_cast<std::size_t>(column)])
      if (--open[static_cast<std::size_t>(i)] == 1) single.push_back(i);
  }
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    if (is_held[static_cast<std::size_t>(j)] == 0) p.columns.push_back(j);
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (open[static_cast<std::size_t>(i)] > 0) p.rows.push_back(i);
  return p;
}

/// Computes the rank of the rows that close loops, and the remaining motions if they are wanted.
void find_motions(LinkComponent& c, const SpanningTree& tree, const std::vector<LinkEdge>& edges,
                  const std::vector<std::pair<int, Twist>>& rows, bool is_wanted, double least_pivot) {
  Matrix kernel;
  if (is_wanted) kernel = Matrix::Identity(c.freedoms, c.freedoms);
  if (!rows.empty() && c.freedoms > 0) {
    Matrix A = Matrix::Zero(static_cast<Eigen::Index>(rows.size()), c.freedoms);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const LinkEdge& edge = edges[static_cast<std::size_t>(rows[i].first)];
      Eigen::RowVectorXd line = Eigen::RowVectorXd::Zero(c.freedoms);
      add_way(tree, edge.second, rows[i].second, 1.0, line);
      add_way(tree, edge.first, rows[i].second, -1.0, line);
      A.row(static_cast<Eigen::Index>(i)) = line;
    }
    const Peeled left = peel(A, least_pivot);
    if (left.columns.size() > most_columns) {
      c.is_rank_known = false;
      c.rank = std::min(c.freedoms, static_cast<int>(rows.size()));
      return;
    }
    c.rank = c.freedoms - static_cast<int>(left.columns.size());
    Matrix of_left = Matrix::Identity(static_cast<Eigen::Index>(left.columns.size()),
                                      static_cast<Eigen::Index>(left.columns.size()));
    if (!left.rows.empty()) {
      Eigen::FullPivLU<Matrix> lu(A(left.rows, left.columns));
      lu.setThreshold(least_pivot);
      c.rank += static_cast<int>(lu.rank());
      if (is_wanted) of_left = c.mobility() > 0 ? Matrix(lu.kernel()) : Matrix(of_left.rows(), 0);
    }
    if (is_wanted) {
      kernel = Matrix::Zero(c.freedoms, c.mobility());
      kernel(left.columns, Eigen::all) = of_left;
    }
  }
  if (!is_wanted) return;
  c.motions = Matrix::Zero(6 * static_cast<Eigen::Index>(c.parts.size()), c.mobility());
  if (c.mobility() == 0) return;
  for (const int part : c.parts) {
    const SpanningTree::Step& s = tree.steps[static_cast<std::size_t>(part)];
    auto own = c.motions.middleRows(6 * c.place.at(part), 6);
    if (s.parent > Linkage::ground) own = c.motions.middleRows(6 * c.place.at(s.parent), 6);
    own += s.sign * s.basis * kernel.middleRows(s.begin, s.basis.cols());
  }
}

}  // namespace

std::vector<LinkComponent> Linkage::solve(MotionsOf wanted, int relaxed) const {
  const auto num_parts = static_cast<std::size_t>(num_parts_);
  SpanningTree tree = make_spanning_tree(edges_, num_parts);
  Sets sets(num_parts);
  for (const LinkEdge& e : edges_)
    if (e.first != ground && e.second != ground)
      sets.join(static_cast<std::size_t>(e.first), static_cast<std::size_t>(e.second));
  std::vector<LinkComponent> components;
  std::vector<int> component_of(num_parts, -1);
  for (const int part : tree.order) {
    int& c = component_of[sets.of(static_cast<std::size_t>(part))];
    if (c < 0) {
      c = static_cast<int>(components.size());
      components.emplace_back();
    }
    LinkComponent& component = components[static_cast<std::size_t>(c)];
    const int edge = tree.steps[static_cast<std::size_t>(part)].edge;
    component.parts.push_back(part);
    component.freedoms += edge < 0 ? 6 : std::max(0, 6 - num_rows(edge, relaxed));
  }
  std::vector<std::vector<int>> closing(components.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const int part = edges_[e].first == ground ? edges_[e].second : edges_[e].first;
    if (part == ground) continue;
    const auto c = static_cast<std::size_t>(component_of[sets.of(static_cast<std::size_t>(part))]);
    components[c].edges.push_back(static_cast<int>(e));
    components[c].reaches_ground |= edges_[e].first == ground || edges_[e].second == ground;
    if (!tree.is_closing[e]) continue;
    components[c].closing_rows += num_rows(static_cast<int>(e), relaxed);
    closing[c].push_back(static_cast<int>(e));
  }
  for (std::size_t k = 0; k < components.size(); ++k) {
    LinkComponent& c = components[k];
    if (static_cast<std::size_t>(c.freedoms) > most_columns || c.parts.size() > most_parts) {
      c.is_rank_known = c.closing_rows == 0;
      c.rank = std::min(c.freedoms, c.closing_rows);
      continue;
    }
    if (wanted == MotionsOf::loops && c.closing_rows == 0) continue;
    const bool is_wanted = wanted != MotionsOf::none;
    c.freedoms = 0;
    for (const int part : c.parts) {
      SpanningTree::Step& step = tree.steps[static_cast<std::size_t>(part)];
      step.begin = c.freedoms;
      if (step.edge >= 0)
        step.basis =
            freedoms_of(edges_[static_cast<std::size_t>(step.edge)], rows_of(step.edge, relaxed), least_pivot_);
      else if (is_wanted || c.closing_rows > 0)
        step.basis = Matrix::Identity(6, 6);
      c.freedoms += step.edge >= 0 ? static_cast<int>(step.basis.cols()) : 6;
      if (is_wanted) c.place.emplace(part, static_cast<int>(c.place.size()));
    }
    std::vector<std::pair<int, Twist>> rows;
    for (const int e : closing[k])
      for (const Twist& row : rows_of(e, relaxed)) rows.emplace_back(e, row);
    find_motions(c, tree, edges_, rows, is_wanted, least_pivot_);
  }
  return components;
}

}  // namespace bough::plan
