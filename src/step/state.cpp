#include "bough/step/state.hpp"

#include <algorithm>

#include "bough/lanes/pack.hpp"
#include "bough/plan/frames.hpp"

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
  plan::FrameMotions frames;
  if (!plan.frames.empty()) frames = plan::frames_at_start(plan);
  field.carriers = frames.in_ground.data();
  for (const plan::JointPlan& j : plan.joints)
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(j.element)], [&](const auto& e) {
      if constexpr (std::is_same_v<std::decay_t<decltype(e)>, elements::Joint>)
        s.turns.push_back(j.counts_turns ? elements::eval_joint_motion(e, field, 0.0).angle : 0.0);
    });
  return s;
}

namespace {

/// What an increment changes of a node.
template <class S>
struct Mover {
  motion::Mat3<S> R;
  motion::PositionPair<S> x;
  motion::Quaternion<S> q;
  motion::Vec6<S> dq;

  void move(const motion::Vec6<S>& eta, bool follow_dq) {
    const motion::Frame<S> step = motion::Se3::exp(eta);
    x.add(R * step.x);
    q = motion::normalise(motion::multiply(q, motion::exp_quaternion(lanes::angular_part(eta))));
    R = motion::rotation_of(q);
    if (follow_dq) dq = motion::Se3::log(motion::compose(motion::Se3::exp(dq), step));
  }
};

}  // namespace

void move_node(State& state, std::size_t node, const motion::Vec6<double>& eta) {
  elements::NodeMotion& n = state.nodes[node];
  Mover<double> m{n.R, n.x, state.rotation[node], n.dq};
  m.move(eta, true);
  n.R = m.R;
  n.x = m.x;
  n.dq = m.dq;
  state.rotation[node] = m.q;
}

void move_nodes(State& state, std::size_t begin, std::size_t count, const motion::Vec6<double>* eta, bool follow_dq) {
  using Pack = lanes::Pack<nodes_in_lanes>;
  Mover<Pack> m;
  motion::Vec6<Pack> step;
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
    const std::size_t k = std::min(l, count - 1);  // spare lanes repeat the last node
    const elements::NodeMotion& n = state.nodes[begin + k];
    const int lane = static_cast<int>(l);
    lanes::set_lane(m.R, lane, n.R);
    lanes::set_lane(m.x.hi, lane, n.x.hi);
    lanes::set_lane(m.x.lo, lane, n.x.lo);
    lanes::set_lane(m.dq, lane, n.dq);
    lanes::set_lane(step, lane, eta[k]);
    m.q.w.set(lane, state.rotation[begin + k].w);
    lanes::set_lane(m.q.v, lane, state.rotation[begin + k].v);
  }
  m.move(step, follow_dq);
  for (std::size_t l = 0; l < count; ++l) {
    elements::NodeMotion& n = state.nodes[begin + l];
    const int lane = static_cast<int>(l);
    n.R = lanes::get_lane(m.R, lane);
    n.x.hi = lanes::get_lane(m.x.hi, lane);
    n.x.lo = lanes::get_lane(m.x.lo, lane);
    if (follow_dq) n.dq = lanes::get_lane(m.dq, lane);
    state.rotation[begin + l].w = m.q.w[lane];
    state.rotation[begin + l].v = lanes::get_lane(m.q.v, lane);
  }
}

}  // namespace bough::step
