#include "moving_nodes.hpp"

#include <algorithm>
#include <limits>

#include "bough/motion/vectors_on.hpp"
#include "element_parts.hpp"
#include "node_lanes.hpp"

namespace bough::step {

using motion::Mat3;
using motion::plane_part;
using motion::PositionPair;
using motion::Quaternion;
using motion::Se2;
using motion::Se3;
using motion::Vec2;
using motion::Vec3;
using motion::Vec6;

namespace {

using Pack = elements::LanePack;
static_assert(elements::num_lanes == static_cast<int>(nodes_in_lanes));

template <class G>
using VectorLanes = typename G::template Vector<Pack>;

/// Layout of a node's numbers in memory: pose, v, dv/dt, dq and drift, one after the other.
template <class G>
struct NodeNumbers {
  static constexpr int all = elements::numbers_of_node<G>, pose = elements::numbers_of_pose<G>, v = pose,
                       dq = elements::numbers_of_rates<G>;
};

Pack larger(const Pack& a, const Pack& b) { return select(less(a, b), b, a); }
double largest_of(const Pack& a) {
  double most = a[0];
  for (int l = 1; l < elements::num_lanes; ++l) most = std::max(most, a[l]);
  return most;
}

template <class G>
Pack angular_square(const VectorLanes<G>& v) {
  return motion::VectorsOn<G>::template angular_square<Pack>(v);
}

/// The motion of a node (or of eight nodes in lanes), and the update of its pose and of dq by an increment eta.
template <class G, class S>
struct Mover;
template <class S>
struct Mover<Se3, S> : elements::NodeMotionOn<Se3, S> {
  using elements::NodeMotionOn<Se3, S>::R, elements::NodeMotionOn<Se3, S>::x, elements::NodeMotionOn<Se3, S>::dq;
  Quaternion<S> q;

  void move(const Vec6<S>& eta, bool follow_dq) {
    const motion::Frame<S> step = Se3::exp(eta);
    x.add(R * step.x);
    q = motion::normalise(motion::multiply(q, motion::exp_quaternion(lanes::angular_part(eta))));
    R = motion::rotation_of(q);
    if (follow_dq) dq = Se3::log(motion::compose(Se3::exp(dq), step));
  }
};
template <class S>
struct Mover<Se2, S> : elements::NodeMotionOn<Se2, S> {
  using elements::NodeMotionOn<Se2, S>::R, elements::NodeMotionOn<Se2, S>::x, elements::NodeMotionOn<Se2, S>::dq;

  /// The angles of dq and eta are added, so that the angle of dq stays correct beyond half a turn.
  void move(const Vec3<S>& eta, bool follow_dq) {
    const auto step = Se2::exp(eta);
    x.add(motion::complex_times(R, step.x));
    R = motion::complex_times(R, step.R);
    R = S(1.5 - 0.5 * lanes::dot(R, R)) * R;  // normalised to first order
    if (!follow_dq) return;
    const auto before = Se2::exp(dq);
    const Vec2<S> way = before.x + motion::complex_times(before.R, step.x);
    const S angle = dq[2] + eta[2];
    const Vec2<S> inverse{{motion::half_cotangent(S(angle * angle)), S(-0.5 * angle)}};
    dq = motion::join(motion::complex_times(inverse, way), angle);
  }
};

/// Where nothing turns, increments add up.
template <int N, class S>
struct Mover<motion::Translations<N>, S> : elements::NodeMotionOn<motion::Translations<N>, S> {
  void move(const lanes::Vec<S, N>& eta, bool follow_dq) {
    this->x.add(eta);
    if (follow_dq) this->dq = this->dq + eta;
  }
};

/// The numbers of eight nodes in lanes.
template <class G>
Pack* numbers_of(Mover<G, Pack>& m) {
  return reinterpret_cast<Pack*>(static_cast<elements::NodeMotionOn<G, Pack>*>(&m));
}
template <class G>
const Pack* numbers_of(const Mover<G, Pack>& m) {
  return reinterpret_cast<const Pack*>(static_cast<const elements::NodeMotionOn<G, Pack>*>(&m));
}
/// Loads poses (and quaternions in space) of up to eight nodes into lanes.
template <class G>
void gather_pose(const NodesOn<G>& nodes, const NodeEight& eight, Mover<G, Pack>& m) {
  gather<NodeNumbers<G>::pose>(nodes.motion.data(), eight, numbers_of(m));
  if constexpr (std::is_same_v<G, Se3>) gather<4>(nodes.rotation.data(), eight, &m.q.w);
}
/// Loads poses, velocities and accelerations.
template <class G>
void gather_motion(const NodesOn<G>& nodes, const NodeEight& eight, Mover<G, Pack>& m) {
  gather<NodeNumbers<G>::dq>(nodes.motion.data(), eight, numbers_of(m));
  if constexpr (std::is_same_v<G, Se3>) gather<4>(nodes.rotation.data(), eight, &m.q.w);
}
/// Stores the first `numbers` numbers of each node.
template <int numbers, class G>
void scatter_motion(const Mover<G, Pack>& m, NodesOn<G>& nodes, const NodeEight& eight) {
  scatter<numbers>(numbers_of(m), nodes.motion.data(), eight);
  if constexpr (std::is_same_v<G, Se3>) scatter<4>(&m.q.w, nodes.rotation.data(), eight);
}
static_assert(sizeof(Quaternion<double>) == 4 * sizeof(double) && offsetof(Quaternion<double>, w) == 0);

constexpr double nothing[12] =
    {};  ///< zeros: the increment of a node without unknowns, and the data of the fixed ground

/// Increments of eight nodes in lanes; zero where a node has no unknowns.
template <class G>
VectorLanes<G> gather_increments(const NodeIncrements& increments, const NodeEight& eight) {
  const double* from[nodes_in_lanes];
  double of_points[nodes_in_lanes][G::dof];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
    const int n = eight.node[l];
    const std::int64_t unknown = increments.unknown_begin[n];
    from[l] = unknown < 0 ? nothing : increments.x + unknown;
    if constexpr (G::turns)
      if (unknown >= 0 && increments.is_point != nullptr && increments.is_point[n] != 0) {
        for (int i = 0; i < G::dof; ++i) of_points[l][i] = i < G::translations ? from[l][i] : 0.0;
        from[l] = of_points[l];
      }
  }
  VectorLanes<G> eta;
  lanes::gather_lanes(from, G::dof, &eta[0]);
  return eta;
}

/// Eight nodes with their poses and dq.
template <class G>
Mover<G, Pack> gather_moving(const NodesOn<G>& nodes, const NodeEight& eight) {
  Mover<G, Pack> m;
  gather_pose(nodes, eight, m);
  gather<G::dof>(nodes.motion.data(), eight, &m.dq[0], NodeNumbers<G>::dq);
  return m;
}
/// Moves them by their increments. Where poses determine dq, only its angle in a plane follows.
template <class G>
void move_by(Mover<G, Pack>& m, const VectorLanes<G>& eta) {
  if constexpr (std::is_same_v<G, Se3>) {
    m.move(eta, true);
  } else {
    m.move(eta, false);
    if constexpr (G::turns) m.dq[2] = m.dq[2] + eta[2];
  }
}

/// An increment in the axes in which positions are given.
Vec6<Pack> turned(const Mat3<Pack>& R, const Vec6<Pack>& eta) {
  return lanes::join(R * lanes::linear_part(eta), R * lanes::angular_part(eta));
}
Vec3<Pack> turned(const Vec2<Pack>& R, const Vec3<Pack>& eta) {
  return motion::join(motion::complex_times(R, plane_part(eta)), eta[2]);
}
template <int N>
lanes::Vec<Pack, N> turned(motion::NoRotation, const lanes::Vec<Pack, N>& eta) {
  return eta;
}

/// Stores the increments of nodes that have not moved by them yet.
template <class G>
void note_change(const Mover<G, Pack>& m, const VectorLanes<G>& eta, const NodeEight& eight, NodeChange<G>* changes) {
  NodeChangeOf<G, Pack> change;
  change.increment = turned(m.R, eta);
  change.place = m.x.hi;
  scatter<NodeChange<G>::numbers>(reinterpret_cast<const Pack*>(&change), changes, eight);
}

}  // namespace

template <class G>
void note_changes(const NodesOn<G>& nodes, std::span<const NodeEight> eights, const NodeIncrements& increments,
                  NodeChange<G>* changes) {
  for (const NodeEight& eight : eights) {
    Mover<G, Pack> m;
    gather_pose(nodes, eight, m);
    note_change(m, gather_increments<G>(increments, eight), eight, changes);
  }
}

template <class G>
void move_nodes(NodesOn<G>& nodes, std::span<const NodeEight> eights, const NodeIncrements& increments,
                NodeChange<G>* changes) {
  for (const NodeEight& eight : eights) {
    Mover<G, Pack> m = gather_moving(nodes, eight);
    const VectorLanes<G> eta = gather_increments<G>(increments, eight);
    if (changes != nullptr) note_change(m, eta, eight, changes);
    move_by(m, eta);
    scatter_motion<NodeNumbers<G>::pose>(m, nodes, eight);
    scatter<G::dof>(&m.dq[0], nodes.motion.data(), eight, NodeNumbers<G>::dq);
  }
}

namespace {

/// Measures the increment since the start of the step. In space a move keeps it up to date.
void measure_increment(const NodesOn<Se3>&, const DriftedStart<Se3>&, std::size_t, const NodeEight&,
                       Mover<Se3, Pack>&) {}
/// dq = log(H_start^-1 H), seen from the frame that drifts, with the accumulated angle, which is correct beyond half a
/// turn. Computed from the poses, it contains no accumulated rounding of single corrections.
void measure_increment(const NodesOn<Se2>& start, const DriftedStart<Se2>& drifted, std::size_t k,
                       const NodeEight& eight, Mover<Se2, Pack>& m) {
  Mover<Se2, Pack> from;
  gather_pose(start, eight, from);
  const Pack angle = m.dq[2];
  Vec2<Pack> way = motion::conjugate_times(from.R, motion::difference(m.x, from.x));
  if (!drifted.eights.empty()) way = way - drifted.eights[k].way;
  const Vec2<Pack> inverse{{motion::half_cotangent(Pack(angle * angle)), -0.5 * angle}};
  m.dq = motion::join(motion::complex_times(inverse, way), angle);
}
template <int N>
void measure_increment(const NodesOn<motion::Translations<N>>& start, const DriftedStart<motion::Translations<N>>&,
                       std::size_t, const NodeEight& eight, Mover<motion::Translations<N>, Pack>& m) {
  Mover<motion::Translations<N>, Pack> from;
  gather_pose(start, eight, from);
  m.dq = motion::difference(m.x, from.x);
}

/// v, dv/dt and a_n at the start of a step, relative to the frames that drift.
template <class G>
struct StartRates {
  VectorLanes<G> v, a, algorithmic;
  StartRates(const NodesOn<G>& start, const DriftedStart<G>& drifted, std::size_t k, const NodeEight& eight) {
    if (!drifted.eights.empty()) {
      const typename DriftedStart<G>::Eight& of = drifted.eights[k];
      v = of.v;
      a = of.a;
      algorithmic = of.algorithmic;
      return;
    }
    VectorLanes<G> rates[2];
    gather<2 * G::dof>(start.motion.data(), eight, &rates[0][0], NodeNumbers<G>::v);
    v = rates[0];
    a = rates[1];
    algorithmic = start.algorithmic.eight(k);
  }
};

/// Sets v, dv/dt and the drift of nodes whose poses are known from the rates relative to frames of velocity `velocity`.
template <class G>
void set_rates(const AlphaRule::Rates<VectorLanes<G>>& now, const typename DriftedStart<G>::Translation& velocity,
               const DriftChoice<G>& choice, Mover<G, Pack>& m) {
  using Translation = typename DriftedStart<G>::Translation;
  const typename G::template Pose<Pack> H{m.R, Translation::zero()};
  Drift<G, Pack> drift{G::turned_back(H, velocity), Translation::zero()};
  if (choice.falls) drift.fall = G::turned_back(H, lanes::cast<Pack>(choice.fall));
  const Translation rate = drift.rate(now.v);
  m.v = without<G, Pack>(now.v, -drift.velocity);
  m.a = without<G, Pack>(now.a, -rate);
  m.drift = drift.velocity;
}

}  // namespace

template <class G>
double correct_nodes(const AlphaRule& rule, const Drifts<G>& drifts, const NodesOn<G>& start, NodesOn<G>& state,
                     const NodeOrder& order, std::size_t begin, std::size_t end, const NodeIncrements& increments,
                     NodeChange<G>* changes) {
  Pack turned(0.0);
  for (std::size_t k = begin; k < end; ++k) {
    const NodeEight& eight = order.eights()[k];
    Mover<G, Pack> m = gather_moving(state, eight);
    const VectorLanes<G> eta = gather_increments<G>(increments, eight);
    note_change(m, eta, eight, changes);
    move_by(m, eta);
    measure_increment(start, drifts.start, k, eight, m);
    const StartRates<G> from(start, drifts.start, k, eight);
    const auto now = rule.follow(m.dq, from.v, from.a, from.algorithmic);
    m.v = now.v;
    m.a = now.a;
    if constexpr (G::turns) {
      m.drift = DriftedStart<G>::Translation::zero();
      if (!drifts.choice.eights.empty()) set_rates<G>(now, drifts.start.eights[k].velocity, drifts.choice, m);
    }
    scatter_motion<NodeNumbers<G>::all>(m, state, eight);
    turned = larger(turned, angular_square<G>(m.dq));
  }
  return largest_of(turned);
}

namespace {

template <class G>
Mover<G, double> mover_of(const NodesOn<G>& nodes, std::size_t node) {
  const auto& n = nodes.motion[node];
  Mover<G, double> m;
  m.R = n.R;
  m.x = n.x;
  m.dq = n.dq;
  if constexpr (std::is_same_v<G, Se3>) m.q = nodes.rotation[node];
  return m;
}
template <class G>
void put(const Mover<G, double>& m, NodesOn<G>& nodes, std::size_t node) {
  auto& n = nodes.motion[node];
  n.R = m.R;
  n.x = m.x;
  n.dq = m.dq;
  if constexpr (std::is_same_v<G, Se3>) nodes.rotation[node] = m.q;
}

}  // namespace

template <class G>
void move_node(NodesOn<G>& nodes, std::size_t node, const typename G::template Vector<double>& eta) {
  Mover<G, double> m = mover_of(nodes, node);
  m.move(eta, true);
  put(m, nodes, node);
}

template <class G>
void place_node(const NodesOn<G>& from, std::size_t node, const typename G::template Vector<double>& d,
                NodesOn<G>& to) {
  Mover<G, double> m = mover_of(from, node);
  m.move(d, false);
  m.dq = d;
  put(m, to, node);
}

template <class G>
void keep_held(const NodesOn<G>& start, NodesOn<G>& state, const NodeOrder& order) {
  for (auto k = static_cast<std::size_t>(order.by_visit().count()); k < order.eights().size(); ++k) {
    const NodeEight& eight = order.eights()[k];
    for (int l = 0; l < eight.count; ++l) {
      const auto n = static_cast<std::size_t>(eight.node[static_cast<std::size_t>(l)]);
      state.motion[n] = start.motion[n];
      if constexpr (std::is_same_v<G, Se3>) state.rotation[n] = start.rotation[n];
    }
    state.algorithmic.eight(k) = start.algorithmic.eight(k);
    state.acceleration_trend.eight(k) = start.acceleration_trend.eight(k);
    state.trend_change.eight(k) = start.trend_change.eight(k);
  }
}

namespace {

/// Takes the start of a step of eight nodes to the frames of their assemblies. Rates of a frame at the time of a_n
/// follow from two terms of their series.
template <class G>
void drift_from(const AlphaRule& rule, const DriftChoice<G>& choice, const Mover<G, Pack>& m,
                const VectorLanes<G>& algorithmic, std::size_t k, DriftedStart<G>& start) {
  using Translation = typename DriftedStart<G>::Translation;
  const double h = rule.h;
  const typename G::template Pose<Pack> H{m.R, Translation::zero()};
  Translation velocity = Translation::zero();
  for (int l = 0; l < elements::num_lanes; ++l) {
    const int assembly = choice.eights[k].assembly[static_cast<std::size_t>(l)];
    if (assembly < 0) continue;
    for (int i = 0; i < G::translations; ++i) velocity[i].set(l, start.frames[static_cast<std::size_t>(assembly)][i]);
  }
  const Drift<G, Pack> drift = drift_at<G, Pack>(H, velocity, lanes::cast<Pack>(choice.fall));
  typename DriftedStart<G>::Eight& to = start.eights[k];
  const Translation rate = drift.rate(m.v), second = drift.second(m.v, m.a);
  to.v = without<G, Pack>(m.v, drift.velocity);
  to.a = without<G, Pack>(m.a, rate);
  to.algorithmic = without<G, Pack>(algorithmic, Translation(rate + (rule.c.shift() * h) * second));
  to.way = h * drift.velocity + (0.5 * h * h) * drift.fall;
  to.velocity = velocity;
  if (choice.falls) to.velocity = Translation(velocity + h * lanes::cast<Pack>(choice.fall));
}

}  // namespace

template <class G>
double predict_nodes(const AlphaRule& rule, const Drifts<G>& drifts, int degree, const NodesOn<G>& start,
                     NodesOn<G>& state, const NodeOrder& order, std::size_t begin, std::size_t end) {
  Pack turned(0.0);
  for (std::size_t k = begin; k < end; ++k) {
    const NodeEight& eight = order.eights()[k];
    Mover<G, Pack> m;
    gather_motion(start, eight, m);
    if constexpr (G::turns)
      if (!drifts.choice.eights.empty())
        drift_from(rule, drifts.choice, m, start.algorithmic.eight(k), k, drifts.start);
    const StartRates<G> from(start, drifts.start, k, eight);
    const VectorLanes<G> change =
        predicted_change(degree, start.acceleration_trend.eight(k), start.trend_change.eight(k));
    const VectorLanes<G> eta = rule.predict(from.v, from.a, from.algorithmic, change);
    const auto now = rule.follow(eta, from.v, from.a, from.algorithmic);
    if constexpr (G::turns)
      if (!drifts.choice.eights.empty()) {
        const typename G::template Pose<Pack> H{m.R, DriftedStart<G>::Translation::zero()};
        m.x.add(G::turned(H, drifts.start.eights[k].way));
      }
    m.move(eta, false);
    m.v = now.v;
    m.a = now.a;
    m.dq = eta;
    if constexpr (G::turns) {
      m.drift = DriftedStart<G>::Translation::zero();
      if (!drifts.choice.eights.empty()) set_rates<G>(now, drifts.start.eights[k].velocity, drifts.choice, m);
    }
    scatter_motion<NodeNumbers<G>::all>(m, state, eight);
    turned = larger(turned, angular_square<G>(eta));
  }
  return largest_of(turned);
}

template <class G>
Workspace::StepEnd finish_nodes(const AlphaRule& rule, const Drifts<G>& drifts, double arm, double per_length,
                                const NodesOn<G>& start, NodesOn<G>& state, const NodeOrder& order, std::size_t begin,
                                std::size_t end, Misses* misses) {
  using Numbers = NodeNumbers<G>;
  const auto size = [arm](const VectorLanes<G>& a) {
    return Pack(lanes::dot(G::linear(a), G::linear(a)) + arm * arm * angular_square<G>(a));
  };
  const auto note_largest = [per_length](const VectorLanes<G>& v, Pack& most) {
    for (int i = 0; i < G::dof; ++i)
      most = larger(most, i < G::translations ? Pack(per_length * lanes::abs(v[i])) : lanes::abs(v[i]));
  };
  Pack error(0.0), increment(0.0), of_changes(0.0);
  for (std::size_t k = begin; k < end; ++k) {
    const NodeEight& eight = order.eights()[k];
    VectorLanes<G> rates[3];  // v, dv/dt and dq
    gather<3 * G::dof>(state.motion.data(), eight, &rates[0][0], Numbers::v);
    const StartRates<G> from(start, drifts.start, k, eight);
    const VectorLanes<G>&trend = start.acceleration_trend.eight(k), &of_trend = start.trend_change.eight(k);
    const auto now = rule.follow(rates[2], from.v, from.a, from.algorithmic);
    const VectorLanes<G> change = now.a - from.a, of_change = change - trend;
    state.algorithmic.eight(k) = now.algorithmic;
    if constexpr (G::turns)
      if (!drifts.choice.eights.empty()) {
        Drift<G, Pack> drift;
        drift.velocity = G::linear(rates[0]) - G::linear(now.v);
        drift.fall = G::linear(rates[1]) - G::linear(now.a) + G::spin(now.v, drift.velocity);
        const auto later = drift.rate(now.v) + (rule.c.shift() * rule.h) * drift.second(now.v, now.a);
        state.algorithmic.eight(k) = without<G, Pack>(now.algorithmic, -later);
      }
    const Pack miss[std::tuple_size_v<Misses>] = {size(change), size(of_change), size(of_change - of_trend)};
    scatter<std::tuple_size_v<Misses>>(miss, misses, eight);
    note_largest(rule.local_error(change, motion::VectorsOn<G>::template bracket<Pack>(now.v, now.a)), error);
    note_largest(rates[2], increment);
    note_largest(of_change, of_changes);
    state.acceleration_trend.eight(k) = change;
    state.trend_change.eight(k) = of_change;
  }
  return {largest_of(error), largest_of(increment), largest_of(of_changes)};
}

namespace {

/// Displacement of the far end of an arm due to the rotation of its near end.
Vec3<Pack> swung(const Vec6<Pack>& change, const Vec3<Pack>& arm) {
  return lanes::cross(lanes::angular_part(change), arm);
}
Vec2<Pack> swung(const Vec3<Pack>& change, const Vec2<Pack>& arm) { return change[2] * motion::quarter_turn(arm); }
template <int N>
lanes::Vec<Pack, N> swung(const lanes::Vec<Pack, N>&, const lanes::Vec<Pack, N>&) {
  return lanes::Vec<Pack, N>::zero();
}

}  // namespace

template <class G>
double largest_change(std::span<const PairLanes> pairs, const NodeChange<G>* changes) {
  const auto look_at = [&](const int(&node)[nodes_in_lanes]) {
    const double* from[nodes_in_lanes];
    for (std::size_t l = 0; l < nodes_in_lanes; ++l)
      from[l] = node[l] < 0 ? nothing : reinterpret_cast<const double*>(changes + node[l]);
    NodeChangeOf<G, Pack> c;
    lanes::gather_lanes(from, NodeChange<G>::numbers, reinterpret_cast<Pack*>(&c));
    return c;
  };
  const Pack far(too_far);
  Pack most(0.0);
  lanes::Mask<elements::num_lanes> near = less(most, far);  // comparisons are false in lanes that hold NaN
  for (const PairLanes& p : pairs) {
    const NodeChangeOf<G, Pack> a = look_at(p.a), b = look_at(p.b);
    const VectorLanes<G> change = b.increment - a.increment;
    const typename G::template Translation<Pack> arm = b.place - a.place, swing = swung(a.increment, arm),
                                                 shift = p.per_length * (G::linear(change) - swing);
    for (int i = 0; i < G::dof; ++i) near = near & less(lanes::abs(i < G::translations ? shift[i] : change[i]), far);
    most = larger(most, larger(lanes::dot(shift, shift), angular_square<G>(change)));
  }
  return all(near) ? largest_of(most) : std::numeric_limits<double>::infinity();
}

#define BOUGH_INSTANTIATE(G)                                                                                           \
  template void note_changes<G>(const NodesOn<G>&, std::span<const NodeEight>, const NodeIncrements&, NodeChange<G>*); \
  template void move_nodes<G>(NodesOn<G>&, std::span<const NodeEight>, const NodeIncrements&, NodeChange<G>*);         \
  template void move_node<G>(NodesOn<G>&, std::size_t, const G::Vector<double>&);                                      \
  template void place_node<G>(const NodesOn<G>&, std::size_t, const G::Vector<double>&, NodesOn<G>&);                  \
  template void keep_held<G>(const NodesOn<G>&, NodesOn<G>&, const NodeOrder&);                                        \
  template double predict_nodes<G>(const AlphaRule&, const Drifts<G>&, int, const NodesOn<G>&, NodesOn<G>&,            \
                                   const NodeOrder&, std::size_t, std::size_t);                                        \
  template double correct_nodes<G>(const AlphaRule&, const Drifts<G>&, const NodesOn<G>&, NodesOn<G>&,                 \
                                   const NodeOrder&, std::size_t, std::size_t, const NodeIncrements&, NodeChange<G>*); \
  template Workspace::StepEnd finish_nodes<G>(const AlphaRule&, const Drifts<G>&, double, double, const NodesOn<G>&,   \
                                              NodesOn<G>&, const NodeOrder&, std::size_t, std::size_t, Misses*);       \
  template double largest_change<G>(std::span<const PairLanes>, const NodeChange<G>*);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

}  // namespace bough::step
