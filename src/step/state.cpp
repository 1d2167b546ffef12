#include "bough/step/state.hpp"

#include <algorithm>

#include "bough/lanes/transpose.hpp"
#include "bough/plan/frames.hpp"

namespace bough::step {

State make_initial_state(const plan::Plan& plan) {
  State s;
  const std::size_t n = plan.nodes.size();
  s.nodes.resize(n);
  s.rotation.resize(n);
  s.algorithmic.assign(n, motion::Vec6<double>::zero());
  s.acceleration_trend = s.trend_change = s.algorithmic;
  s.multipliers.assign(static_cast<std::size_t>(plan.num_multipliers), 0.0);
  s.multiplier_trend = s.multiplier_trend_change = s.multipliers;
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
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint)
        s.turns.push_back(j.counts_turns ? elements::eval_joint_angle(e, field, 0.0) : 0.0);
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
  static_assert(std::is_standard_layout_v<elements::NodeMotion> && sizeof(Mover<double>::R) == 9 * sizeof(double));
  constexpr int num_pose = 15;  // of R and the position, which come first
  const double *pose[nodes_in_lanes], *turn[nodes_in_lanes], *increment[nodes_in_lanes], *dq[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
    const std::size_t k = std::min(l, count - 1);  // spare lanes repeat the last node
    const elements::NodeMotion& n = state.nodes[begin + k];
    pose[l] = n.R.m;
    dq[l] = &n.dq[0];
    turn[l] = &state.rotation[begin + k].w;
    increment[l] = &eta[k][0];
  }
  Mover<Pack> m;
  motion::Vec6<Pack> step;
  Pack placed[num_pose], turned[4];
  lanes::gather_lanes(pose, num_pose, placed);
  lanes::gather_lanes(turn, 4, turned);
  lanes::gather_lanes(increment, 6, &step[0]);
  if (follow_dq) lanes::gather_lanes(dq, 6, &m.dq[0]);
  for (int i = 0; i < 9; ++i) m.R.m[i] = placed[i];
  for (int i = 0; i < 3; ++i) {
    m.x.hi[i] = placed[9 + i];
    m.x.lo[i] = placed[12 + i];
    m.q.v[i] = turned[1 + i];
  }
  m.q.w = turned[0];
  m.move(step, follow_dq);
  for (int i = 0; i < 9; ++i) placed[i] = m.R.m[i];
  for (int i = 0; i < 3; ++i) {
    placed[9 + i] = m.x.hi[i];
    placed[12 + i] = m.x.lo[i];
    turned[1 + i] = m.q.v[i];
  }
  turned[0] = m.q.w;
  double nowhere[num_pose], *to_pose[nodes_in_lanes], *to_turn[nodes_in_lanes], *to_dq[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
    to_pose[l] = to_turn[l] = to_dq[l] = nowhere;
    if (l >= count) continue;
    elements::NodeMotion& n = state.nodes[begin + l];
    to_pose[l] = n.R.m;
    to_turn[l] = &state.rotation[begin + l].w;
    to_dq[l] = &n.dq[0];
  }
  lanes::scatter_lanes(placed, num_pose, to_pose);
  lanes::scatter_lanes(turned, 4, to_turn);
  if (follow_dq) lanes::scatter_lanes(&m.dq[0], 6, to_dq);
}

}  // namespace bough::step
