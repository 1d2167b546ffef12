#include "minimal_form.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace bough::run {

namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

constexpr std::size_t most_states = 500, most_unknowns = 4000;  ///< of dense matrices
constexpr double is_dependent = 1e-9;      ///< of a scaled row, over the largest: what is left of it by the others
constexpr double no_mass = 1e-12;          ///< of a scaled mass, over the largest
constexpr double round_off_entry = 1e-10;  ///< of an entry, over the largest of its kind, that is round-off

double largest_entry(const Matrix& a) { return a.size() > 0 ? a.cwiseAbs().maxCoeff() : 0.0; }

/// Entries of some rows and columns as a dense matrix; place: of an unknown among those, -1: it is none.
Matrix dense_of(const records::SparseEntries& sparse, const std::vector<Index>& row_place, Index rows,
                const std::vector<Index>& column_place, Index columns) {
  Matrix a = Matrix::Zero(rows, columns);
  for (std::size_t k = 0; k < sparse.value.size(); ++k) {
    const Index i = row_place[static_cast<std::size_t>(sparse.row[k])],
                j = column_place[static_cast<std::size_t>(sparse.column[k])];
    if (i >= 0 && j >= 0) a(i, j) += sparse.value[k];
  }
  return a;
}

records::DenseMatrix by_rows(const Matrix& a) {
  records::DenseMatrix stored{static_cast<int>(a.rows()), static_cast<int>(a.cols()), {}};
  for (Index i = 0; i < a.rows(); ++i)
    for (Index j = 0; j < a.cols(); ++j) stored.value.push_back(a(i, j));
  return stored;
}

/// What depends linearly on the motions q, their rates, the states of signals r and the inputs.
struct Follows {
  Matrix q, rate, r, u;
};

class MinimalForm {
 public:
  explicit MinimalForm(const LinearEquations& e) : e_(e), n_(e.kinds.size()) {
    for (const UnknownKind kind :
         {UnknownKind::motion, UnknownKind::multiplier, UnknownKind::signal, UnknownKind::state}) {
      std::vector<Index>& places = place_[static_cast<std::size_t>(kind)];
      places.assign(n_, -1);
      for (std::size_t i = 0; i < n_; ++i)
        if (e.kinds[i] == kind) places[i] = count_[static_cast<std::size_t>(kind)]++;
    }
    for (std::size_t i = 0; i < n_; ++i)
      if (e.kinds[i] == UnknownKind::motion) motions_.push_back(i);
    for (std::size_t i = 0; i < n_; ++i)
      if (e.kinds[i] == UnknownKind::state) states_.push_back(i);
  }

  std::string run(records::LinearModel::Minimal& to) {
    if (n_ > most_unknowns) return "there are more than " + std::to_string(most_unknowns) + " unknowns";
    std::string why = eliminate_signals();
    if (why.empty()) why = eliminate_constrained();
    if (why.empty()) why = eliminate_accelerations();
    if (why.empty()) why = write(to);
    return why;
  }

 private:
  using Kind = UnknownKind;
  Index count(Kind kind) const { return count_[static_cast<std::size_t>(kind)]; }
  Matrix block(const records::SparseEntries& of, Kind rows, Kind columns) const {
    return dense_of(of, place_[static_cast<std::size_t>(rows)], count(rows), place_[static_cast<std::size_t>(columns)],
                    count(columns));
  }
  Matrix output_block(const records::SparseEntries& of, Kind columns) const {
    std::vector<Index> rows(static_cast<std::size_t>(of.rows));
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = static_cast<Index>(k);
    return dense_of(of, rows, of.rows, place_[static_cast<std::size_t>(columns)], count(columns));
  }

  /// S s = -(K_q q + C_q q' + K_r r) + b u for signals without a rate.
  std::string eliminate_signals() {
    const Index s = count(Kind::signal), m = count(Kind::motion), r = count(Kind::state),
                u = static_cast<Index>(e_.inputs.size());
    if (largest_entry(block(e_.K, Kind::signal, Kind::multiplier)) > 0.0 ||
        largest_entry(block(e_.K, Kind::state, Kind::multiplier)) > 0.0)
      return "a signal reads the force of a constraint";
    Matrix b = Matrix::Zero(s, u);
    for (Index k = 0; k < u; ++k)
      b(place_[static_cast<std::size_t>(Kind::signal)][e_.inputs[static_cast<std::size_t>(k)]], k) = 1.0;
    if (s == 0) {
      signals_ = {Matrix::Zero(0, m), Matrix::Zero(0, m), Matrix::Zero(0, r), b};
      return {};
    }
    const Eigen::PartialPivLU<Matrix> S(block(e_.K, Kind::signal, Kind::signal));
    signals_ = {-S.solve(block(e_.K, Kind::signal, Kind::motion)), -S.solve(block(e_.C, Kind::signal, Kind::motion)),
                -S.solve(block(e_.K, Kind::signal, Kind::state)), S.solve(b)};
    return {};
  }

  /// G q = 0 by rows in units of one another: the motions that rows with the largest pivots determine follow the others,
  /// q = Z q_free.
  std::string eliminate_constrained() {
    const Index m = count(Kind::motion);
    const Matrix of_signals = block(e_.K, Kind::multiplier, Kind::signal);
    Matrix G = block(e_.K, Kind::multiplier, Kind::motion);
    const double scale = largest_entry(G);
    for (const Matrix* part : {&signals_.rate, &signals_.r, &signals_.u})
      if (largest_entry(of_signals * *part) > round_off_entry * scale)
        return "an input or a signal that depends on velocities or states prescribes a motion, whose velocities and "
               "accelerations act too";
    const Matrix forces = G.transpose();  // of multipliers; those of signals do not count
    G += of_signals * signals_.q;
    Eigen::VectorXd unit(m);
    for (Index i = 0; i < m; ++i) unit[i] = 1.0 / std::sqrt(e_.weights[motions_[static_cast<std::size_t>(i)]]);
    Z_ = Matrix::Identity(m, m);
    left_ = Z_;
    rank_ = 0;
    free_.clear();
    for (Index i = 0; i < m; ++i) free_.push_back(i);
    if (G.rows() > 0) {
      Matrix scaled = G * unit.asDiagonal();
      for (Index i = 0; i < scaled.rows(); ++i)
        if (const double length = scaled.row(i).norm(); length > 0.0) scaled.row(i) /= length;
      Eigen::ColPivHouseholderQR<Matrix> qr(scaled);
      qr.setThreshold(is_dependent);
      rank_ = qr.rank();
      const Index f = m - rank_;
      const Matrix R = qr.matrixR().topRows(rank_);
      const Matrix bound = -R.leftCols(rank_).triangularView<Eigen::Upper>().solve(R.rightCols(f));
      const auto order = qr.colsPermutation().indices();
      free_.clear();
      for (Index k = 0; k < f; ++k) free_.push_back(order[rank_ + k]);
      Z_ = Matrix::Zero(m, f);
      for (Index k = 0; k < f; ++k) {
        Z_(free_[static_cast<std::size_t>(k)], k) = 1.0;
        for (Index i = 0; i < rank_; ++i)
          Z_(order[i], k) = unit[order[i]] * bound(i, k) / unit[free_[static_cast<std::size_t>(k)]];
      }
      left_ = Z_;
      if (largest_entry(of_signals * signals_.q) >
          0.0) {  // forces of constraints do no work on other motions than G q = 0
        const Matrix T = (unit.asDiagonal() * forces).transpose();
        const Eigen::FullPivLU<Matrix> lu(T);
        left_ = unit.asDiagonal() * lu.kernel();
        if (left_.cols() != Z_.cols()) return "constraints driven by signals depend on each other";
      }
    }
    return {};
  }

  /// left^T (M Z z'' + C Z z' + K Z z + ...) = 0 for z'', and for the rate or the value of motions without mass.
  std::string eliminate_accelerations() {
    const Matrix Ks = block(e_.K, Kind::motion, Kind::signal);
    const Matrix Lt = left_.transpose();
    mass_ = block(e_.M, Kind::motion, Kind::motion);
    const Matrix C = block(e_.C, Kind::motion, Kind::motion) + Ks * signals_.rate;
    const Matrix K = block(e_.K, Kind::motion, Kind::motion) + Ks * signals_.q;
    force_of_states_ = block(e_.K, Kind::motion, Kind::state) + Ks * signals_.r;
    force_of_inputs_ = Ks * signals_.u;
    if (largest_entry(block(e_.C, Kind::motion, Kind::state)) > 0.0 ||
        largest_entry(block(e_.C, Kind::motion, Kind::signal)) > 0.0)
      return "forces depend on rates of signals";
    damping_ = C;
    stiffness_ = K;
    const Matrix M = Lt * mass_ * Z_, Cz = Lt * C * Z_, Kz = Lt * K * Z_;
    const Index f = M.rows();
    double most = 0.0;
    Eigen::VectorXd unit(f);
    for (Index k = 0; k < f; ++k) {
      unit[k] = 1.0 / std::sqrt(e_.weights[motions_[static_cast<std::size_t>(free_[static_cast<std::size_t>(k)])]]);
      most = std::max(most, std::abs(M(k, k)) * unit[k] * unit[k]);
    }
    // Free motions without mass come last.
    std::vector<Index> with, without;
    for (Index k = 0; k < f; ++k)
      (M.col(k).cwiseProduct(unit).cwiseAbs().maxCoeff() * unit[k] > no_mass * most ? with : without).push_back(k);
    const auto a = static_cast<Index>(with.size()), b = static_cast<Index>(without.size());
    num_with_ = a;
    order_ = with;
    order_.insert(order_.end(), without.begin(), without.end());
    const auto pick = [&](const Matrix& A, bool of_rows) -> Matrix {
      Matrix picked(A.rows(), A.cols());
      for (Index k = 0; k < f && A.size() > 0; ++k) {
        const Index from = order_[static_cast<std::size_t>(k)];
        if (of_rows)
          picked.row(k) = A.row(from);
        else
          picked.col(k) = A.col(from);
      }
      return picked;
    };
    const Matrix Mo = pick(pick(M, true), false), Co = pick(pick(Cz, true), false), Ko = pick(pick(Kz, true), false),
                 Ro = pick(Lt * force_of_states_, true), Uo = pick(Lt * force_of_inputs_, true);
    const Eigen::FullPivLU<Matrix> solver(Mo.topLeftCorner(a, a));
    if (a > 0 && !solver.isInvertible()) return "some combination of motions has no mass";
    // x = (z1, z1', z0 where it has damping, r)
    const Matrix C00 = Co.bottomRightCorner(b, b), K00 = Ko.bottomRightCorner(b, b);
    has_rates_ = b > 0 && largest_entry(C00) > 0.0;
    const Index r = count(Kind::state), u = Uo.cols(), last = has_rates_ ? b : 0, size = 2 * a + last + r;
    Matrix rate0 = Matrix::Zero(b, size), rate0_u = Matrix::Zero(b, u), value0 = Matrix::Zero(b, size),
           value0_u = Matrix::Zero(b, u);
    if (b > 0) {
      Matrix known = Matrix::Zero(b, size);
      known.leftCols(a) = Ko.bottomLeftCorner(b, a);
      known.middleCols(a, a) = Co.bottomLeftCorner(b, a);
      if (r > 0) known.rightCols(r) = Ro.bottomRows(b);
      const Matrix known_u = Uo.bottomRows(b);
      const Eigen::FullPivLU<Matrix> lu(has_rates_ ? C00 : K00);
      if (!lu.isInvertible())
        return has_rates_ ? "of several motions without mass some are damped and some are not"
                          : "a motion has neither mass nor stiffness";
      if (has_rates_) {
        known.middleCols(2 * a, b) = K00;
        rate0 = -lu.solve(known);
        rate0_u = -lu.solve(known_u);
        value0.middleCols(2 * a, b) = Matrix::Identity(b, b);
      } else {
        if (largest_entry(Co.bottomLeftCorner(b, a)) > round_off_entry * largest_entry(Co) ||
            largest_entry(Co.topRightCorner(a, b)) > 0.0)
          return "motions without mass are damped by those of others";
        value0 = -lu.solve(known);
        value0_u = -lu.solve(known_u);
      }
    }
    Matrix sum = Matrix::Zero(a, size), sum_u = Uo.topRows(a);
    sum.leftCols(a) = Ko.topLeftCorner(a, a);
    sum.middleCols(a, a) = Co.topLeftCorner(a, a);
    sum.rightCols(r) += Ro.topRows(a);
    if (b > 0) {
      sum += Ko.topRightCorner(a, b) * value0 + Co.topRightCorner(a, b) * rate0;
      sum_u += Ko.topRightCorner(a, b) * value0_u + Co.topRightCorner(a, b) * rate0_u;
    }
    A_ = Matrix::Zero(size, size);
    B_ = Matrix::Zero(size, u);
    A_.block(0, a, a, a) = Matrix::Identity(a, a);
    if (a > 0) {
      A_.middleRows(a, a) = -solver.solve(sum);
      B_.middleRows(a, a) = -solver.solve(sum_u);
    }
    A_.middleRows(2 * a, last) = rate0.topRows(last);
    B_.middleRows(2 * a, last) = rate0_u.topRows(last);
    // z, z' and z'' of all free motions by x and u; what has neither mass nor damping has a rate by the chain rule.
    value_ = Matrix::Zero(f, size);
    value_u_ = Matrix::Zero(f, u);
    rate_ = value_;
    rate_u_ = value_u_;
    second_ = value_;
    second_u_ = value_u_;
    value_.block(0, 0, a, a) = Matrix::Identity(a, a);
    rate_.block(0, a, a, a) = Matrix::Identity(a, a);
    second_.topRows(a) = A_.middleRows(a, a);
    second_u_.topRows(a) = B_.middleRows(a, a);
    if (b > 0) {
      value_.bottomRows(b) = value0;
      value_u_.bottomRows(b) = value0_u;
      rate_.bottomRows(b) = rate0;
      rate_u_.bottomRows(b) = rate0_u;
    }
    is_quasistatic_ = b > 0 && !has_rates_;
    // States of signals: C_r r' = -(K_q q + C_q q' + K_s s + K_r r).
    if (r > 0) {
      const Matrix Krs = block(e_.K, Kind::state, Kind::signal);
      const Eigen::PartialPivLU<Matrix> own(block(e_.C, Kind::state, Kind::state));
      const Matrix q = block(e_.K, Kind::state, Kind::motion) + Krs * signals_.q,
                   v = block(e_.C, Kind::state, Kind::motion) + Krs * signals_.rate;
      const Matrix Zo = pick(Z_, false);
      Matrix of_x = q * Zo * value_ + v * Zo * rate_;
      of_x.rightCols(r) += block(e_.K, Kind::state, Kind::state) + Krs * signals_.r;
      A_.bottomRows(r) = -own.solve(of_x);
      B_.bottomRows(r) = -own.solve(q * Zo * value_u_ + v * Zo * rate_u_ + Krs * signals_.u);
    }
    Zo_ = pick(Z_, false);
    return {};
  }

  std::string write(records::LinearModel::Minimal& to) const {
    const Index size = A_.rows(), u = B_.cols(), r = count(Kind::state);
    if (size > static_cast<Index>(most_states))
      return "it would have " + std::to_string(size) + " states, more than " + std::to_string(most_states);
    const Matrix q = Zo_ * value_, q_u = Zo_ * value_u_, v = Zo_ * rate_, v_u = Zo_ * rate_u_, a = Zo_ * second_,
                 a_u = Zo_ * second_u_;
    const Matrix of_rates = output_block(e_.of_rates, Kind::motion),
                 of_accelerations = output_block(e_.of_accelerations, Kind::motion),
                 of_forces = output_block(e_.of_values, Kind::multiplier),
                 of_signals = output_block(e_.of_values, Kind::signal);
    if (is_quasistatic_ && (largest_entry(of_rates) > 0.0 || largest_entry(of_accelerations) > 0.0))
      return "an output is a rate or an acceleration, and some motions have no mass";
    if (has_rates_ && largest_entry(of_accelerations) > 0.0)
      return "an output is an acceleration, and some motions have no mass";
    Matrix T = Matrix::Zero(static_cast<Index>(n_), size), U = Matrix::Zero(static_cast<Index>(n_), u);
    Matrix C = output_block(e_.of_values, Kind::motion) * q + of_rates * v + of_accelerations * a;
    Matrix D = output_block(e_.of_values, Kind::motion) * q_u + of_rates * v_u + of_accelerations * a_u;
    Matrix s = signals_.q * q + signals_.rate * v;
    s.rightCols(r) += signals_.r;
    const Matrix s_u = signals_.q * q_u + signals_.rate * v_u + signals_.u;
    C += of_signals * s;
    D += of_signals * s_u;
    C.rightCols(r) += output_block(e_.of_values, Kind::state);
    const Matrix Gt = block(e_.K, Kind::motion, Kind::multiplier);
    if (Gt.cols() > 0 && largest_entry(of_forces) > 0.0) {
      if (rank_ < Gt.cols()) return "an output is the force of a constraint, which is not unique";
      // G^T lambda = -(M q'' + C q' + K q + forces of signals)
      Matrix left = mass_ * a + damping_ * v + stiffness_ * q;
      left.rightCols(r) += force_of_states_;
      const Matrix left_u = mass_ * a_u + damping_ * v_u + stiffness_ * q_u + force_of_inputs_;
      Eigen::VectorXd unit(Gt.rows());
      for (Index i = 0; i < Gt.rows(); ++i)
        unit[i] = 1.0 / std::sqrt(e_.weights[motions_[static_cast<std::size_t>(i)]]);
      const Eigen::ColPivHouseholderQR<Matrix> qr(unit.asDiagonal() * Gt);
      C += of_forces * qr.solve(unit.asDiagonal() * -left);
      D += of_forces * qr.solve(unit.asDiagonal() * -left_u);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      const auto put = [&](const Matrix& x, const Matrix& of_u, Index row) {
        T.row(static_cast<Index>(i)) = x.row(row);
        U.row(static_cast<Index>(i)) = of_u.row(row);
      };
      if (e_.kinds[i] == Kind::motion) put(q, q_u, place_[static_cast<std::size_t>(Kind::motion)][i]);
      if (e_.kinds[i] == Kind::signal) put(s, s_u, place_[static_cast<std::size_t>(Kind::signal)][i]);
      if (e_.kinds[i] == Kind::state)
        T(static_cast<Index>(i), size - r + place_[static_cast<std::size_t>(Kind::state)][i]) = 1.0;
    }
    const auto unknown = [&](Index k) {
      return motions_[static_cast<std::size_t>(free_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])])];
    };
    for (Index k = 0; k < num_with_; ++k) to.states.push_back(e_.names[unknown(k)]);
    for (Index k = 0; k < num_with_; ++k) to.states.push_back(e_.rates[unknown(k)]);
    for (Index k = num_with_; has_rates_ && k < static_cast<Index>(order_.size()); ++k)
      to.states.push_back(e_.names[unknown(k)]);
    for (const std::size_t i : states_) to.states.push_back(e_.names[i]);
    to.A = by_rows(A_);
    to.B = by_rows(B_);
    to.C = by_rows(C);
    to.D = by_rows(D);
    to.T = by_rows(T);
    return {};
  }

  const LinearEquations& e_;
  const std::size_t n_;
  std::array<std::vector<Index>, 4> place_;
  std::array<Index, 4> count_{};
  std::vector<std::size_t> motions_, states_;
  Follows signals_;  ///< signals without a rate
  Matrix Z_, left_, Zo_, mass_, damping_, stiffness_, force_of_states_, force_of_inputs_;
  Index rank_ = 0, num_with_ = 0;
  std::vector<Index> free_, order_;
  bool has_rates_ = false, is_quasistatic_ = false;
  Matrix A_, B_, value_, value_u_, rate_, rate_u_, second_, second_u_;
};

}  // namespace

std::string make_minimal(const LinearEquations& equations, records::LinearModel::Minimal& minimal) {
  return MinimalForm(equations).run(minimal);
}

}  // namespace bough::run
