#include "tangent_matrix.hpp"

#include <cmath>
#include <stdexcept>

#include "bough/run/memory_run.hpp"
#include "bough/run/simulate.hpp"

namespace bough::stress {

TangentMatrix tangent_matrix(const scene::Scene& scene) {
  TangentMatrix t;
  std::string trouble;
  run::SimulateOptions options;
  options.before_step = [&](step::System& system, const step::State& start, const run::BeforeStep& step) {
    step::State state = start;
    elements::Slopes slopes;
    const auto failed = [&trouble](const std::optional<step::Trouble>& x) {
      if (x) trouble = x->text;
      return x.has_value();
    };
    if (scene.analysis.kind == scene::AnalysisKind::dynamics) {
      if (failed(step::predict(system, state, step.options, step.end, slopes))) return false;
    } else if (failed(system.set_time(step.end))) {
      return false;
    }
    if (failed(system.evaluate(state, slopes, true)) || failed(system.linear().factor(true, slopes))) return false;
    const auto n = static_cast<Eigen::Index>(system.linear().tree().num_unknowns());  // of the linear system
    t.matrix.resize(n, n);
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      unit(j) = 1.0;
      system.linear().solver().multiply(system.walker(), unit.data(), t.matrix.col(j).data());
      unit(j) = 0.0;
    }
    t.row_scale = t.column_scale = Eigen::VectorXd::Ones(n);
    if (const solve::Hierarchical* h = system.linear().solver().hierarchical(); h != nullptr) {
      t.row_scale = Eigen::Map<const Eigen::VectorXd>(h->row_scale().data(), n);
      t.column_scale = Eigen::Map<const Eigen::VectorXd>(h->column_scale().data(), n);
    }
    t.scaled = t.row_scale.asDiagonal() * t.matrix * t.column_scale.asDiagonal();
    t.rhs = Eigen::Map<const Eigen::VectorXd>(system.right_hand_side().data(), n);
    t.solution.resize(n);
    const solve::SolveReport solved = system.linear().solver().solve(system.walker(), t.rhs.data(), t.solution.data());
    if (!solved.finite) trouble = "the solution of the linear system is not finite";
    t.backward_error = solved.backward_error;
    return false;
  };
  const run::MemoryRun run = run::run_in_memory(scene, options);
  if (trouble.empty() && t.matrix.size() == 0) trouble = run.summary.cause;
  if (!trouble.empty()) throw std::runtime_error(trouble);
  return t;
}

double condition_of(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values(0) / values(values.size() - 1);
}

double condition_without_scaling(const TangentMatrix& t) {
  const Eigen::MatrixXd inverse =
      t.column_scale.asDiagonal() * t.scaled.partialPivLu().inverse() * t.row_scale.asDiagonal();
  return t.matrix.norm() * inverse.norm();
}

void equilibrate(const Eigen::MatrixXd& matrix, Eigen::VectorXd& row, Eigen::VectorXd& column) {
  row = Eigen::VectorXd::Ones(matrix.rows());
  column = Eigen::VectorXd::Ones(matrix.cols());
  for (int sweep = 0; sweep < 30; ++sweep) {
    const Eigen::MatrixXd scaled = (row.asDiagonal() * matrix * column.asDiagonal()).cwiseAbs();
    const auto factor = [](double most) { return most > 0.0 ? 1.0 / std::sqrt(most) : 1.0; };
    for (Eigen::Index i = 0; i < row.size(); ++i) {
      row(i) *= factor(scaled.row(i).maxCoeff());
      column(i) *= factor(scaled.col(i).maxCoeff());
    }
  }
}

}  // namespace bough::stress
