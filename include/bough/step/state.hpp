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
  bool follows_trend = false;                  ///< whether the last step was nearer to its trend than to its start
  double last_step = 0.0;                      ///< h that dq spans, of the variational integrator [s]; 0 at a start
  std::vector<motion::Vec6<double>> momentum;  ///< p_n of the variational integrator, own axes; else empty
  std::vector<motion::Vec6<double>>
      unsettled;  ///< statics: eta that nodes still lack and their digits cannot hold; else empty
  std::vector<double> multipliers;
  /// Not 0: the first four vectors and the multipliers of joints that hold nodes are those of an earlier time; only the System whose step of this
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
