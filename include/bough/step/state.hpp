#pragma once
/// Everything that changes during a run, as plain data: two equal states continue equally.
#include <cstdint>
#include <vector>

#include "bough/elements/evaluate.hpp"
#include "bough/motion/quaternion.hpp"
#include "bough/plan/plan.hpp"

namespace bough::step {

struct State {
  double time = 0.0;                                     ///< [s], or the load factor in statics
  double step_size = 0.0;                                ///< h that `algorithmic` belongs to [s]; 0 before the start
  std::vector<elements::NodeMotion> nodes;               ///< R, x, v, dv/dt, and dq since the last accepted step
  std::vector<motion::Quaternion<double>> rotation;      ///< of nodes; R is made from it
  std::vector<motion::Vec6<double>> algorithmic;         ///< a_n, the acceleration-like variable of generalized-alpha
  std::vector<motion::Vec6<double>> acceleration_trend;  ///< change of dv/dt over the last step, of generalized-alpha
  std::vector<motion::Vec6<double>> trend_change;        ///< change of that from the step before; zero after a start
  /// Order of the polynomial through past dv/dt that would have been nearest to the last step: 0, 1 or 2.
  int predictor_order = 0;
  /// Of the last step of generalized-alpha, the largest over all nodes, lengths over the size of the structure: its local
  /// error without the filter of stiff parts (step_control.hpp), 0 after a start; and dq.
  double local_error = 0.0, increment = 0.0;
  double last_step = 0.0;                      ///< h that dq spans, of the variational integrator [s]; 0 at a start
  std::vector<motion::Vec6<double>> momentum;  ///< p_n of the variational integrator, own axes; else empty
  std::vector<motion::Vec6<double>>
      unsettled;  ///< statics: eta that nodes still lack and their digits cannot hold; else empty
  std::vector<double> multipliers;
  std::vector<double> multiplier_trend;         ///< change of multipliers over the last step; zero after a start
  std::vector<double> multiplier_trend_change;  ///< change of that from the step before; zero after a start
  int multiplier_order = 0;                     ///< as predictor_order
  /// Not 0: the first five vectors and the multipliers of joints that hold nodes are those of an earlier time; only the System whose step of this
  /// number ended here knows the others, see System::catch_up.
  std::int64_t behind = 0;
  std::vector<double> turns;  ///< angle of each joint at the last accepted step [rad]
};

/// The scene's own poses and twists, not yet consistent.
State make_initial_state(const plan::Plan& plan);

/// H <- H exp(eta) of one node, and dq <- log(exp(dq) exp(eta)).
void move_node(State& state, std::size_t node, const motion::Vec6<double>& eta);

/// The same for nodes [begin, begin + count), 1 <= count <= nodes_in_lanes, one to a lane: the bits of move_node. eta: `count` increments.
/// Without `follow_dq` dq is left as it is.
inline constexpr std::size_t nodes_in_lanes = 8;
void move_nodes(State& state, std::size_t begin, std::size_t count, const motion::Vec6<double>* eta, bool follow_dq);

}  // namespace bough::step
