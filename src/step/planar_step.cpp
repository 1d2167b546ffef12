#include "planar_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/lanes/transpose.hpp"
#include "system_parts.hpp"

namespace bough::step {

using lanes::Vec;
using motion::Mat3;
using motion::plane_part;
using motion::Vec2;
using motion::Vec3;
using motion::Vec6;

/// Where a node stands, and where it stood when the step began.
template <class S>
struct PlanarStep::PlanarMover {
  Vec2<S> turn;
  elements::planar::PairOf<S> x;
  S angle;  ///< since the start

  /// H <- H exp(eta)
  void move(const Vec3<S>& eta) {
    const Vec<S, 8> c = motion::eval_stumpff(S(eta[2] * eta[2]));
    const Vec2<S> e{{c[0], eta[2] * c[1]}}, f{{c[1], eta[2] * c[2]}};
    const Vec2<S> step = motion::complex_times(turn, motion::complex_times(f, plane_part(eta)));
    for (int i = 0; i < 2; ++i) {
      S s, error;
      motion::two_sum(x.hi[i], step[i], s, error);
      motion::two_sum(s, S(x.lo[i] + error), x.hi[i], x.lo[i]);
    }
    turn = motion::complex_times(turn, e);
    turn = S(1.5 - 0.5 * lanes::dot(turn, turn)) * turn;  // back to size one, to first order
    angle += eta[2];
  }
  /// log(H_start^-1 H); the angle is known beyond half a turn.
  Vec3<S> increment(const Vec2<S>& start_turn, const elements::planar::PairOf<S>& start_x) const {
    Vec2<S> way;
    for (int i = 0; i < 2; ++i) {
      S s, error;
      motion::two_sum(x.hi[i], S(-start_x.hi[i]), s, error);
      way[i] = s + (error + (x.lo[i] - start_x.lo[i]));
    }
    const Vec2<S> inverse{{motion::half_cotangent(S(angle * angle)), -0.5 * angle}};
    return motion::join(motion::complex_times(inverse, motion::conjugate_times(start_turn, way)), angle);
  }
};

namespace {

using Pack = elements::LanePack;
using PlanarNodeLanes = elements::planar::NodeLanes;
static_assert(elements::num_lanes == static_cast<int>(nodes_in_lanes));
constexpr double nothing[3] = {0.0, 0.0, 0.0};  ///< increment of a node without unknowns

/// A motion of a node in the plane as one in space, its own axes: columns of B along the plane, along the plane, normal.
Vec6<Pack> in_space(const Mat3<Pack>& B, const Vec3<Pack>& z) {
  Vec6<Pack> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = B(i, 0) * z[0] + B(i, 1) * z[1];
    v[3 + i] = B(i, 2) * z[2];
  }
  return v;
}
Vec3<Pack> in_plane(const Mat3<Pack>& B, const Vec6<Pack>& v) {
  const auto along = [&B](int column, const Pack* x) {
    return B(0, column) * x[0] + (B(1, column) * x[1] + B(2, column) * x[2]);
  };
  return {{along(0, v.v), along(1, v.v), along(2, v.v + 3)}};
}

/// Addresses of what lies at nodes [begin, begin + count), one to a lane; spare lanes repeat the last.
template <class Item, class Number>
struct LanesOf {
  Number* at[nodes_in_lanes];
  LanesOf(Item* items, std::size_t begin, std::size_t count) {
    for (std::size_t l = 0; l < nodes_in_lanes; ++l)
      at[l] = reinterpret_cast<Number*>(items + begin + std::min(l, count - 1));
  }
};
template <class Item>
void gather(const Item* items, std::size_t begin, std::size_t count, int numbers, Pack* to) {
  lanes::gather_lanes(LanesOf<const Item, const double>(items, begin, count).at, numbers, to);
}
/// Spare lanes hold what the last does, so they may write it as well.
template <class Item>
void scatter(const Pack* from, int numbers, Item* items, std::size_t begin, std::size_t count) {
  lanes::scatter_lanes(from, numbers, LanesOf<Item, double>(items, begin, count).at);
}

using SpaceLanes = elements::NodeMotionOf<Pack>;
constexpr int numbers_of_motion = 33, numbers_before_increment = 27;
static_assert(sizeof(elements::NodeMotion) == numbers_of_motion * sizeof(double) &&
              sizeof(SpaceLanes) == numbers_of_motion * sizeof(Pack));

Mat3<Pack> gather_basis(const plan::Plan& plan, std::size_t begin, std::size_t count) {
  Mat3<Pack> B = Mat3<Pack>::identity();
  if (!plan.unknowns.basis.empty()) gather(plan.unknowns.basis.data(), begin, count, 9, B.m);
  return B;
}

}  // namespace

PlanarStep::PlanarStep(const plan::Plan& plan, PlanarSystem& system, const std::vector<std::int64_t>& node_begin,
                       const std::vector<NodePair>& pairs)
    : plan_(plan), system_(system), node_begin_(node_begin), pairs_(pairs), starts_(plan.nodes.size()) {
  chunk_max_.resize((pairs.size() + pair_grain - 1) / pair_grain);
  turn_max_.resize((starts_.size() + block_grain - 1) / block_grain);
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.planar->elements, plan.directory[id], [&](const auto& e) {
      if constexpr (std::is_same_v<std::decay_t<decltype(e)>, elements::planar::Joint>)
        if (std::any_of(e.rows, e.rows + e.num_rows,
                        [](const auto& row) { return row.kind != elements::RowKind::along; }))
          joints_with_angles_.push_back(static_cast<int>(id));
    });
}

void PlanarStep::enter(const State& start, const AlphaRule& rule, const tree::Walker& walker) {
  rule_ = rule;
  is_under_way_ = true;
  auto by_node = [&](std::int64_t begin, std::int64_t end) { enter_nodes(start, begin, end); };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), block_grain, tree::make_chunk(by_node));
}

void PlanarStep::enter_nodes(const State& start, std::int64_t begin, std::int64_t end) {
  turn_max_[static_cast<std::size_t>(begin / block_grain)] = 0.0;
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<double>& origin = plan_.planar->origin;
  for (std::int64_t first = begin; first < end; first += nodes_in_lanes) {
    const auto from = static_cast<std::size_t>(first);
    const auto count = static_cast<std::size_t>(std::min<std::int64_t>(nodes_in_lanes, end - first));
    SpaceLanes node;
    Vec6<Pack> algorithmic, trend = Vec6<Pack>::zero();
    gather(start.nodes.data(), from, count, numbers_before_increment, node.R.m);
    gather(start.algorithmic.data(), from, count, 6, algorithmic.v);
    if (start.follows_trend) gather(start.acceleration_trend.data(), from, count, 6, trend.v);
    const Mat3<Pack> B = gather_basis(plan_, from, count);
    // As PlanarSystem::set_nodes.
    StartNode<Pack> s;
    const Vec3<Pack> axis = node.R * lanes::column(B, 0);
    Vec3<Pack> hi, lo;
    for (int i = 0; i < 3; ++i) {
      motion::two_sum(node.x.hi[i], Pack(-origin[i]), hi[i], lo[i]);
      lo[i] = lo[i] + node.x.lo[i];
    }
    for (int i = 0; i < 2; ++i) {
      const Vec3<Pack> along = lanes::cast<Pack>(lanes::column(axes, i));
      s.turn[i] = lanes::dot(along, axis);
      s.x.hi[i] = lanes::dot(along, hi);
      s.x.lo[i] = lanes::dot(along, lo);
    }
    s.v = in_plane(B, node.v);
    s.a = in_plane(B, node.a);
    s.algorithmic = in_plane(B, algorithmic);
    scatter(&s.turn[0], numbers_of_start, starts_.data(), from, count);
    move_nodes(from, count, s, PlanarMover<Pack>{s.turn, s.x, Pack(0.0)},
               rule_.predict(s.v, s.a, s.algorithmic, in_plane(B, trend)), true);
  }
}

double PlanarStep::apply(const double* x, const tree::Walker& walker) {
  auto by_pair = [&](std::int64_t begin, std::int64_t end) {
    chunk_max_[static_cast<std::size_t>(begin / pair_grain)] = largest_change(x, begin, end);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(pairs_.size()), pair_grain, tree::make_chunk(by_pair));
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    turn_max_[static_cast<std::size_t>(begin / block_grain)] = 0.0;
    for (std::int64_t first = begin; first < end; first += nodes_in_lanes) {
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(nodes_in_lanes, end - first));
      const auto from = static_cast<std::size_t>(first);
      Vec3<Pack> eta;
      for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
        const std::int64_t at = node_begin_[from + std::min(l, count - 1)];
        const double* const increment = at < 0 ? nothing : x + at;
        for (int i = 0; i < 3; ++i) eta[i].set(static_cast<int>(l), increment[i]);
      }
      StartNode<Pack> start;
      gather(starts_.data(), from, count, numbers_of_start, &start.turn[0]);
      PlanarNodeLanes node;
      gather(system_.nodes().data(), from, count, elements::planar::numbers_of_node, &node.turn[0]);
      move_nodes(from, count, start, PlanarMover<Pack>{node.turn, node.x, node.dq[2]}, eta, false);
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), block_grain, tree::make_chunk(by_node));
  double most = 0.0;
  for (const double size : chunk_max_) most = std::max(most, size);
  return std::sqrt(most);
}

/// The largest square of a shift or a turn of pairs [begin, end); infinite where one is too far.
double PlanarStep::largest_change(const double* x, std::int64_t begin, std::int64_t end) const {
  const elements::planar::Node* const nodes = system_.nodes().data();
  const auto turned = [&](std::size_t n) {
    const std::int64_t at = node_begin_[n];
    const double* const eta = at < 0 ? nothing : x + at;
    return motion::join(motion::complex_times(nodes[n].turn, Vec2<double>{{eta[0], eta[1]}}), eta[2]);
  };
  double most = 0.0;
  for (std::int64_t k = begin; k < end; ++k) {
    const NodePair& p = pairs_[static_cast<std::size_t>(k)];
    const auto b = static_cast<std::size_t>(p.b);
    Vec3<double> change = turned(b);
    if (p.a >= 0) {
      const auto a = static_cast<std::size_t>(p.a);
      const Vec3<double> other = turned(a);
      const Vec2<double> arm = nodes[b].x.hi - nodes[a].x.hi;
      change -= motion::join(Vec2<double>(plane_part(other) + other[2] * motion::quarter_turn(arm)), other[2]);
    }
    const Vec2<double> shift = p.per_length * plane_part(change);
    const double largest = std::max({std::abs(shift[0]), std::abs(shift[1]), std::abs(change[2])});
    if (!(largest < too_far)) return std::numeric_limits<double>::infinity();
    most = std::max({most, lanes::dot(shift, shift), change[2] * change[2]});
  }
  return most;
}

/// Nodes [begin, begin + count), one to a lane, 1 <= count <= nodes_in_lanes.
void PlanarStep::move_nodes(std::size_t begin, std::size_t count, const StartNode<Pack>& start, PlanarMover<Pack> mover,
                            const Vec3<Pack>& eta, bool is_first) {
  mover.move(eta);
  PlanarNodeLanes n;
  n.dq = is_first ? eta : mover.increment(start.turn, start.x);
  const AlphaRule::Rates<Vec3<Pack>> rates = rule_.follow(n.dq, start.v, start.a, start.algorithmic);
  n.turn = mover.turn;
  n.x = mover.x;
  n.v = rates.v;
  n.a = rates.a;
  std::vector<elements::planar::Node>& nodes = system_.nodes();
  scatter(&n.turn[0], elements::planar::numbers_of_node, nodes.data(), begin, count);
  double& most = turn_max_[begin / static_cast<std::size_t>(block_grain)];
  for (std::size_t l = 0; l < count; ++l) most = std::max(most, std::abs(nodes[begin + l].dq[2]));
}

int PlanarStep::turned_beyond(double angle) const {
  if (std::all_of(turn_max_.begin(), turn_max_.end(), [angle](double turn) { return turn <= angle; })) return -1;
  const std::vector<elements::planar::Node>& nodes = system_.nodes();
  const auto far = std::find_if(nodes.begin(), nodes.end(),
                                [angle](const elements::planar::Node& n) { return std::abs(n.dq[2]) > angle; });
  return far == nodes.end() ? -1 : static_cast<int>(far - nodes.begin());
}

std::int64_t PlanarStep::first_folded(const tree::Walker& walker) const {
  const auto count = static_cast<std::int64_t>(plan_.directory.size());
  FirstBad first_bad(count);
  const std::vector<elements::planar::Node>& nodes = system_.nodes();
  const auto turn_of = [&nodes](const elements::planar::Port& p) {
    if (p.node == elements::ground) return p.turn;
    const Vec2<double>& node = nodes[static_cast<std::size_t>(p.node)].turn;
    return p.has_offset ? motion::complex_times(node, p.turn) : node;
  };
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t id = begin; id < end; ++id)
      plan::with_element(plan_.planar->elements, plan_.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
        if constexpr (requires { e.reference_strain; }) {
          const Vec2<double> first = turn_of(e.ports[0]);
          for (int i = 1; i < std::decay_t<decltype(e)>::num_ports; ++i)
            if (lanes::dot(first, turn_of(e.ports[i])) < folded) return first_bad.note(id);
        }
      });
  };
  walker.for_each_chunk(count, element_grain, tree::make_chunk(by_element));
  return first_bad.get();
}

void PlanarStep::leave(const State& start, State& state, const tree::Walker& walker) {
  is_under_way_ = false;
  state.nodes.resize(starts_.size());
  state.rotation.resize(starts_.size());
  state.algorithmic.resize(starts_.size());
  const Mat3<double>& axes = plan_.planar->axes;
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t first = begin; first < end; first += nodes_in_lanes) {
      const auto from = static_cast<std::size_t>(first);
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(nodes_in_lanes, end - first));
      PlanarNodeLanes node;
      StartNode<Pack> s;
      SpaceLanes to;
      Pack turn[4];
      gather(system_.nodes().data(), from, count, elements::planar::numbers_of_node, &node.turn[0]);
      gather(starts_.data(), from, count, numbers_of_start, &s.turn[0]);
      gather(start.nodes.data(), from, count, 15, to.R.m);  // and the place, which stands next
      gather(start.rotation.data(), from, count, 4, turn);
      const Mat3<Pack> B = gather_basis(plan_, from, count);
      to.v = in_space(B, node.v);
      to.a = in_space(B, node.a);
      to.dq = in_space(B, node.dq);
      const Vec6<Pack> algorithmic = in_space(B, rule_.follow(node.dq, s.v, s.a, s.algorithmic).algorithmic);
      const motion::Quaternion<Pack> q =
          motion::normalise(motion::multiply(motion::Quaternion<Pack>{turn[0], {{turn[1], turn[2], turn[3]}}},
                                             motion::exp_quaternion(lanes::angular_part(to.dq))));
      to.R = motion::rotation_of(q);
      turn[0] = q.w;
      for (int i = 0; i < 3; ++i) turn[1 + i] = q.v[i];
      // The place itself goes into space as a displacement, so that its digits beyond a double stay.
      Vec2<Pack> hi, lo;
      for (int i = 0; i < 2; ++i) {
        motion::two_sum(node.x.hi[i], Pack(-s.x.hi[i]), hi[i], lo[i]);
        lo[i] = lo[i] + (node.x.lo[i] - s.x.lo[i]);
      }
      const Vec3<Pack> along[2] = {lanes::cast<Pack>(lanes::column(axes, 0)),
                                   lanes::cast<Pack>(lanes::column(axes, 1))};
      for (const Vec2<Pack>& part : {hi, lo}) to.x.add(part[0] * along[0] + part[1] * along[1]);
      scatter(to.R.m, numbers_of_motion, state.nodes.data(), from, count);
      scatter(turn, 4, state.rotation.data(), from, count);
      scatter(algorithmic.v, 6, state.algorithmic.data(), from, count);
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), block_grain, tree::make_chunk(by_node));
}

}  // namespace bough::step
