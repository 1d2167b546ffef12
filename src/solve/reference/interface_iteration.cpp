/// The interface problem by iteration, for comparison: preconditioned conjugate gradients, or GMRES.
#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "dual_state.hpp"

namespace bough::solve {

namespace {
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double iteration_tolerance = 1e-12;  ///< of the residual, relative to the right-hand side

struct Outcome {
  int iterations = 0;
  bool converged = false;
};

/// Conjugate gradients [Hestenes, Stiefel 1952]; stops if the matrix turns out not to be positive definite.
Outcome conjugate_gradients(const Matrix& A, const Matrix& preconditioner, const Vector& b, Vector& x, int most) {
  Outcome o;
  const double goal = iteration_tolerance * b.norm();
  Vector r = b - A * x, z = preconditioner * r, p = z;
  double rz = r.dot(z);
  while (o.iterations < most && r.norm() > goal) {
    const Vector Ap = A * p;
    const double curvature = p.dot(Ap);
    if (!(curvature > 0.0) || !(rz > 0.0)) return o;
    x += (rz / curvature) * p;
    r -= (rz / curvature) * Ap;
    z = preconditioner * r;
    const double next = r.dot(z);
    p = (z + (next / rz) * p).eval();
    rz = next;
    ++o.iterations;
  }
  o.converged = r.norm() <= goal;
  return o;
}

/// GMRES [Saad, Schultz 1986], preconditioned on the right, not restarted: at most as many iterations as unknowns.
Outcome gmres(const Matrix& A, const Matrix& preconditioner, const Vector& b, Vector& x, int most) {
  Outcome o;
  const double beta = b.norm();
  const auto n = b.size();
  Matrix V(n, most + 1), H = Matrix::Zero(most + 1, most);
  Vector g = Vector::Zero(most + 1), c(most), s(most);
  V.col(0) = b / beta;
  g(0) = beta;
  while (o.iterations < most && std::abs(g(o.iterations)) > iteration_tolerance * beta) {
    const int k = o.iterations++;
    Vector w = A * (preconditioner * V.col(k));
    for (int sweep = 0; sweep < 2; ++sweep)
      for (int i = 0; i <= k; ++i) {
        const double h = w.dot(V.col(i));
        H(i, k) += h;
        w -= h * V.col(i);
      }
    const double norm = w.norm();
    for (int i = 0; i < k; ++i) {
      const double upper = c(i) * H(i, k) + s(i) * H(i + 1, k);
      H(i + 1, k) = c(i) * H(i + 1, k) - s(i) * H(i, k);
      H(i, k) = upper;
    }
    const double radius = std::hypot(H(k, k), norm);
    if (radius == 0.0) break;
    c(k) = H(k, k) / radius;
    s(k) = norm / radius;
    H(k, k) = radius;
    g(k + 1) = -s(k) * g(k);
    g(k) *= c(k);
    if (norm <= 1e-300) break;
    V.col(k + 1) = w / norm;
  }
  const int k = o.iterations;
  const Vector y = H.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
  x = preconditioner * Vector(V.leftCols(k) * y);
  o.converged = (A * x - b).norm() <= 1e3 * iteration_tolerance * beta;
  return o;
}
}  // namespace

/// Each tie averages the boundary stiffnesses of its two sides: M = sum 1/2 B_i S_i B_i^T 1/2 (Dirichlet preconditioner
/// [Farhat, Mandel, Roux 1994]); S_i: the leaf's boundary, with unknowns without ties eliminated or, in the interface
/// mesh, fixed.
void Dual::State::assemble_preconditioner() {
  const int waiting = static_cast<int>(reduced.rows()) - num_ties();
  preconditioner = Matrix::Identity(reduced.rows(), reduced.rows());
  preconditioner.bottomRightCorner(num_ties(), num_ties()).setZero();
  for (const LeafInterface& leaf : leaves) {
    const int refused = fronts.num_refused(leaf.id);
    std::vector<int> tied, inside;
    std::vector<char> is_tied(leaf.boundary.size(), 0);
    for (const int p : leaf.tie_boundary) is_tied[at(p)] = 1;
    for (int i = 0; i < refused; ++i) inside.push_back(i);
    std::vector<int> place(leaf.boundary.size(), -1);
    for (std::size_t p = 0; p < leaf.boundary.size(); ++p) {
      if (is_tied[p] != 0) {
        place[p] = static_cast<int>(tied.size());
        tied.push_back(refused + static_cast<int>(p));
      } else if (leaf.boundary[p].coarse < 0) {
        inside.push_back(refused + static_cast<int>(p));
      }
    }
    const auto part = [&](const std::vector<int>& rows, const std::vector<int>& columns) {
      Matrix m(rows.size(), columns.size());
      for (std::size_t j = 0; j < columns.size(); ++j)
        for (std::size_t i = 0; i < rows.size(); ++i)
          m(static_cast<int>(i), static_cast<int>(j)) = fronts.condensed(leaf.id, rows[i], columns[j]);
      return m;
    };
    Matrix S = part(tied, tied);
    if (!inside.empty()) {
      const std::optional<Matrix> moved = solve_if_regular(part(inside, inside), part(inside, tied));
      if (moved) S -= part(tied, inside) * *moved;
    }
    for (std::size_t t = 0; t < leaf.ties.size(); ++t)
      for (std::size_t s = 0; s < leaf.ties.size(); ++s) {
        const auto [i, sign_i] = leaf.ties[t];
        const auto [j, sign_j] = leaf.ties[s];
        preconditioner(waiting + i, waiting + j) += 0.25 * sign_i * sign_j / (tie_scale[at(i)] * tie_scale[at(j)]) *
                                                    S(place[at(leaf.tie_boundary[t])], place[at(leaf.tie_boundary[s])]);
      }
  }
}

bool Dual::State::iterate(const Vector& rhs, Vector& x) {
  x.setZero();
  if (rhs.size() == 0 || rhs.norm() == 0.0) return true;
  const int n = static_cast<int>(rhs.size());
  if (is_symmetric) {
    const Outcome o = conjugate_gradients(reduced, preconditioner, rhs, x, 4 * n + 50);
    iterations += o.iterations;
    if (o.converged) return true;
    x.setZero();
  }
  const Outcome o = gmres(reduced, preconditioner, rhs, x, n);
  iterations += o.iterations;
  if (o.converged) return true;
  // A singular preconditioner (joints at the tie itself) is not used.
  const Outcome bare = gmres(reduced, Matrix::Identity(n, n), rhs, x, n);
  iterations += bare.iterations;
  return bare.converged;
}

}  // namespace bough::solve
