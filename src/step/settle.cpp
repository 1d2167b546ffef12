#include "settle.hpp"

#include <vector>

namespace bough::step {

namespace {

/// Evaluates the residual as sensors do: by the elements in space, bit by bit. The matrices stay those of the last
/// evaluation.
std::optional<Trouble> evaluate_as_seen(System& system, const State& state) {
  if (state.is_in_space()) return system.evaluate(state, {}, false);
  system.elements().evaluate_as_seen(state);
  return system.sum(state);
}

void find_unsettled(System& system, State& state) {
  state.unsettled.clear();
  Workspace& work = system.work();
  LinearSolution& linear = system.linear();
  if (evaluate_as_seen(system, state)) return;
  work.rhs = system.right_hand_side();
  if (!linear.is_of_matrices() && linear.factor(false, {})) return;
  if (linear.solve(work.rhs.data(), work.x.data())) return;
  const std::size_t num_nodes = system.plan().nodes.size();
  for (State* s : {&state, &work.start, &work.before}) s->unsettled.reserve(num_nodes);  // copies need no memory then
  state.unsettled.resize(num_nodes);
  for (std::size_t n = 0; n < num_nodes; ++n)
    state.unsettled[n] = system.places().node_part(work.x.data(), static_cast<int>(n));
  system.corrections().add_multipliers(state, work.x.data(), 1.0);
}

}  // namespace

void settle(System& system, State& state) {
  find_unsettled(system, state);
  system.recover_multipliers(state);
}

}  // namespace bough::step
