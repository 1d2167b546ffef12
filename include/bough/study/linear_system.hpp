#pragma once
/// The linear system of one step of a run, for use by other programs.
#include <optional>
#include <string>
#include <vector>

#include "bough/io/matrix_market.hpp"
#include "bough/scene/scene.hpp"

namespace bough::study {

/// Which step: the first one unless a number or a time is given. Both count load steps and the load factor in statics.
struct StepChoice {
  std::optional<long> number = {};  ///< of accepted steps, from 1
  std::optional<double> time = {};  ///< [s]: the first step that ends at this time or later
};

/// The interface of one sub-domain in the units of the scene, on the displacements that local multipliers tie to the
/// interface mesh. Matrices by columns.
struct InterfaceSystem {
  std::vector<std::string> unknowns;  ///< owner and number of the component, from 1
  std::vector<double> stiffness;      ///< S, the sub-domain condensed to them
  std::vector<double> penalty;        ///< P, diagonal, as a whole matrix
  std::vector<double> flexibility;    ///< F = (S + P)^-1
  double condition = 1.0;             ///< of P^1/2 F P^1/2

  /// Comment lines for a file of one of the matrices, "F", "S" or "P", in this step.
  std::vector<std::string> comments(const std::string& matrix, long step) const;
};

/// Consecutive unknowns of one owner: the increment eta of a node's frame (H <- H exp(eta)), or the multipliers of a
/// joint.
struct UnknownBlock {
  std::string owner;  ///< "'bob'", "joint 'hinge'"
  std::string components;
  int first = 0, count = 0;
};

/// A x = b of the first Newton iteration of a step: A the tangent at the predicted state, b minus the residual there.
/// SI units, increments in the nodes' own axes.
struct LinearSystem {
  io::SparseMatrix matrix;  ///< entries that are exactly zero left out
  std::vector<double> rhs;
  std::vector<double> solution;  ///< by the scene's solver; empty if the matrix is singular (see trouble)
  double backward_error = 0.0;   ///< of the solution, in scaled variables [-]
  std::vector<UnknownBlock> blocks;
  bool is_dynamic = true;
  long step = 0;                             ///< number
  double begin = 0.0, end = 0.0;             ///< of the step [s], or load factors
  std::string trouble;                       ///< why there is no solution
  std::optional<InterfaceSystem> interface;  ///< if one was asked for, and the system was factored

  /// Description of the unknowns and of the system's origin: comment lines at the head of a file.
  std::vector<std::string> comments(const std::string& scene_name) const;
};

/// Runs the scene up to the chosen step and makes its linear system. Precondition: problems_in(scene) is empty. Returns
/// none if there is no such step or if the run fails before it; `cause` then says why. The matrix counts as symmetric
/// if entries agree with their mirror images within 1e-14 of the largest entry of their rows; the mean of both is then
/// stored.
/// interface: path of a sub-domain of the solver's tree, as "0.1", whose interface is wanted; empty: none is.
std::optional<LinearSystem> make_linear_system(const scene::Scene& scene, const StepChoice& choice, int threads,
                                               std::string& cause, const std::string& interface = {});

}  // namespace bough::study
