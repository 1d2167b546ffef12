#include "bough/step/state.hpp"

#include "bough/elements/limits.hpp"
#include "bough/plan/frames.hpp"
#include "bough/plan/stores.hpp"
#include "moving_nodes.hpp"

namespace bough::step {

using motion::Se3;
using motion::Vec3;
using motion::Vec6;

namespace {

/// A motion vector of space, own axes, in the components of the nodes' group.
Vec6<double> restricted(const plan::Plan&, const SpatialNodes&, std::size_t, const Vec6<double>& v) { return v; }
template <class G>
typename NodesOn<G>::Vector restricted(const plan::Plan& plan, const NodesOn<G>&, std::size_t node,
                                       const Vec6<double>& v) {
  typename NodesOn<G>::Vector z = NodesOn<G>::Vector::zero();
  plan.unknowns.project(v, node, &z[0]);
  return z;
}

}  // namespace

State make_initial_state(const plan::Plan& plan) {
  State s;
  SpatialNodes& nodes = s.emplace<Se3>();
  const std::size_t n = plan.nodes.size();
  nodes.motion.resize(n);
  nodes.rotation.resize(n);
  s.multipliers.assign(static_cast<std::size_t>(plan.num_multipliers), 0.0);
  s.multiplier_trend = s.multiplier_trend_change = s.multipliers;
  for (const plan::SignalPlan& signal : plan.signals) s.signals.value.push_back(signal.start);
  s.signals.rate.assign(plan.signals.size(), 0.0);
  s.signals.given = s.signals.rate;
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    if (plan.signals[i].rule == plan::SignalRule::input) s.signals.given[i] = plan.signals[i].start;
  s.signals.algorithmic = s.signals.trend = s.signals.rate;
  for (std::size_t i = 0; i < n; ++i) {
    elements::NodeMotion& node = nodes.motion[i];
    nodes.rotation[i] = motion::normalise(motion::quaternion_of(plan.nodes[i].pose.R));
    node.R = motion::rotation_of(nodes.rotation[i]);
    node.x = motion::Vec3Pair::from(plan.nodes[i].pose.x);
    node.v = plan.nodes[i].twist;
    if (plan.nodes[i].is_point) node.v = lanes::join(lanes::linear_part(node.v), Vec3<double>::zero());
    node.a = node.dq = Vec6<double>::zero();
    node.drift = Vec3<double>::zero();
  }
  elements::Field field;
  field.nodes = nodes.motion.data();
  plan::FrameMotions frames;
  if (!plan.frames.empty()) frames = plan::frames_at_start(plan);
  field.carriers = frames.in_ground.data();
  s.turns.assign(plan.joints.size(), 0.0);
  for (const int j : plan.turning_joints)
    s.turns[static_cast<std::size_t>(j)] = elements::eval_joint_angle(plan::joint_element(plan, j), field, 0.0);
  plan.with_group([&]<class G>() {
    if constexpr (!std::is_same_v<G, Se3>) {
      NodesOn<G>& reduced = s.emplace<G>();
      reduced.motion.resize(n);
      s.in_space_.nodes.reserve(n);
      const auto none = NodesOn<G>::Vector::zero();
      const std::vector<plan::NodeStartOn<G>>& starts = std::get<plan::ModelOn<G>>(plan.model).nodes;
      for (std::size_t i = 0; i < n; ++i)
        reduced.motion[i] = {starts[i].turn, starts[i].x, restricted(plan, reduced, i, plan.nodes[i].twist),
                             none,           none,        {}};
    }
  });
  return s;
}

State make_spatial(const plan::Plan& plan, const State& state) {
  State s = state;
  if (state.is_in_space()) return s;
  SpatialNodes& nodes = s.emplace<Se3>();
  nodes.motion = nodes_in_space(plan, state);
  for (const elements::NodeMotion& n : nodes.motion)
    nodes.rotation.push_back(motion::normalise(motion::quaternion_of(n.R)));
  return s;
}

void move_node(const plan::Plan& plan, State& state, std::size_t node, const Vec6<double>& eta) {
  state.change_all([&](auto& nodes) { move_node(nodes, node, restricted(plan, nodes, node, eta)); });
}
void set_velocity(const plan::Plan& plan, State& state, std::size_t node, const Vec6<double>& v) {
  state.change_all([&](auto& nodes) { nodes.motion[node].v = restricted(plan, nodes, node, v); });
}
void set_acceleration(const plan::Plan& plan, State& state, std::size_t node, const Vec6<double>& a) {
  state.change_all([&](auto& nodes) { nodes.motion[node].a = restricted(plan, nodes, node, a); });
}
void set_at_rest(State& state) {
  state.change_all([](auto& nodes) {
    for (auto& n : nodes.motion) n.dq = n.v = n.a = std::decay_t<decltype(nodes)>::Vector::zero();
  });
}

}  // namespace bough::step
