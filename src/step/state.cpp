#include "bough/step/state.hpp"

namespace bough::step {

State make_initial_state(const plan::Plan& plan) {
  State s;
  const std::size_t n = plan.nodes.size();
  s.nodes.resize(n);
  s.rotation.resize(n);
  s.algorithmic.assign(n, motion::Vec6<double>::zero());
  s.multipliers.assign(static_cast<std::size_t>(plan.num_multipliers), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    elements::NodeMotion& node = s.nodes[i];
    s.rotation[i] = motion::normalise(motion::quaternion_of(plan.nodes[i].pose.R));
    node.R = motion::rotation_of(s.rotation[i]);
    node.x = motion::Vec3Pair::from(plan.nodes[i].pose.x);
    node.v = plan.nodes[i].twist;
    node.a = node.dq = motion::Vec6<double>::zero();
  }
  elements::Field field;
  field.nodes = s.nodes.data();
  for (const plan::JointPlan& j : plan.joints)
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(j.element)], [&](const auto& e) {
      if constexpr (std::is_same_v<std::decay_t<decltype(e)>, elements::Joint>)
        s.turns.push_back(j.counts_turns ? elements::eval_joint_motion(e, field, 0.0).angle : 0.0);
    });
  return s;
}

void move_node(State& state, std::size_t node, const motion::Vec6<double>& eta) {
  elements::NodeMotion& n = state.nodes[node];
  const motion::Frame<double> step = motion::Se3::exp(eta);
  n.x.add(n.R * step.x);
  motion::Quaternion<double>& q = state.rotation[node];
  q = motion::normalise(motion::multiply(q, motion::exp_quaternion(lanes::angular_part(eta))));
  n.R = motion::rotation_of(q);
  n.dq = motion::Se3::log(motion::compose(motion::Se3::exp(n.dq), step));
}

}  // namespace bough::step
