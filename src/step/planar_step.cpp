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

namespace {

using Pack = elements::LanePack;
using PlanarNodeLanes = elements::planar::NodeLanes;
static_assert(elements::num_lanes == static_cast<int>(nodes_in_lanes));
constexpr std::int64_t group_grain = block_grain / static_cast<std::int64_t>(nodes_in_lanes);
constexpr std::int64_t pair_group_grain = pair_grain / static_cast<std::int64_t>(nodes_in_lanes);
constexpr double nothing[4] = {};  ///< increment of a node without unknowns; what is read of a node where there is none

/// Increments of eight nodes by their first unknowns, -1: none.
Vec3<Pack> gather_increments(const double* x, const std::int64_t* unknown) {
  const double* from[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) from[l] = unknown[l] < 0 ? nothing : x + unknown[l];
  Vec3<Pack> eta;
  lanes::gather_lanes(from, 3, &eta[0]);
  return eta;
}

/// Of a port in its node's axes, or on the ground.
Vec2<double> own_turn(const elements::planar::Port& p) {
  return p.node == elements::ground || p.has_offset ? p.turn : Vec2<double>{{1.0, 0.0}};
}

/// A motion of a node in the plane as one in space, its own axes: columns of B along the plane, along the plane, normal.
Vec6<Pack> in_space(const Mat3<Pack>& B, const Vec3<Pack>& z) {
  Vec6<Pack> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = B(i, 0) * z[0] + B(i, 1) * z[1];
    v[3 + i] = B(i, 2) * z[2];
  }
  return v;
}
Pack larger(const Pack& a, const Pack& b) { return select(less(a, b), b, a); }
double largest_of(const Pack& a) {
  double most = a[0];
  for (int l = 1; l < elements::num_lanes; ++l) most = std::max(most, a[l]);
  return most;
}
Vec3<Pack> in_plane(const Mat3<Pack>& B, const Vec6<Pack>& v) {
  const auto along = [&B](int column, const Pack* x) {
    return B(0, column) * x[0] + (B(1, column) * x[1] + B(2, column) * x[2]);
  };
  return {{along(0, v.v), along(1, v.v), along(2, v.v + 3)}};
}

/// Numbers of an item from `number` on.
template <int numbers, class Item>
void gather(const Item* items, std::size_t begin, std::size_t count, Pack* to, std::size_t number = 0) {
  if (count == nodes_in_lanes) {  // addresses at fixed distances need no registers of their own
    const double* from = reinterpret_cast<const double*>(items + begin) + number;
    return lanes::gather_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  const double* from[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l)
    from[l] = reinterpret_cast<const double*>(items + begin + std::min(l, count - 1)) + number;
  lanes::gather_lanes(from, numbers, to);
}
/// Spare lanes hold what the last does, so they may write it as well.
template <int numbers, class Item>
void scatter(const Pack* from, Item* items, std::size_t begin, std::size_t count) {
  if (count == nodes_in_lanes) {
    double* to = reinterpret_cast<double*>(items + begin);
    return lanes::scatter_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  double* to[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l)
    to[l] = reinterpret_cast<double*>(items + begin + std::min(l, count - 1));
  lanes::scatter_lanes(from, numbers, to);
}

using SpaceLanes = elements::NodeMotionOf<Pack>;
constexpr int numbers_of_motion = 33, numbers_before_increment = 27;
constexpr std::size_t numbers_before_place = 9;
static_assert(sizeof(elements::NodeMotion) == numbers_of_motion * sizeof(double) &&
              sizeof(SpaceLanes) == numbers_of_motion * sizeof(Pack));

}  // namespace

PlanarStep::PlanarStep(const plan::Plan& plan, PlanarSystem& system, const std::vector<std::int64_t>& node_begin,
                       const std::vector<NodePair>& pairs)
    : plan_(plan), system_(system) {
  place_pairs(pairs, node_begin);
  const std::size_t groups = (plan.nodes.size() + nodes_in_lanes - 1) / nodes_in_lanes;
  bases_.assign(groups, Mat3<Pack>::identity());
  if (!plan.unknowns.basis.empty())
    for (std::size_t g = 0; g < groups; ++g)
      gather<9>(plan.unknowns.basis.data(), g * nodes_in_lanes, count_of(g), bases_[g].m);
  starts_.resize(groups);
  movers_.resize(groups);
  unknowns_ = node_begin;
  unknowns_.resize(groups * nodes_in_lanes, node_begin.empty() ? -1 : node_begin.back());
  turn_max_.resize((groups + group_grain - 1) / group_grain);
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.planar->elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (std::is_same_v<E, elements::planar::Joint>)
        if (std::any_of(e.rows, e.rows + e.num_rows,
                        [](const auto& row) { return row.kind != elements::RowKind::along; }))
          joints_with_angles_.push_back(static_cast<int>(id));
      if constexpr (requires { e.reference_strain; })
        for (int i = 1; i < E::num_ports; ++i)
          beam_ends_.push_back({static_cast<std::int64_t>(id), e.ports[0].node, e.ports[i].node,
                                motion::conjugate_times(own_turn(e.ports[0]), own_turn(e.ports[i]))});
    });
}

void PlanarStep::place_pairs(const std::vector<NodePair>& pairs, const std::vector<std::int64_t>& node_begin) {
  pairs_.resize((pairs.size() + nodes_in_lanes - 1) / nodes_in_lanes);
  chunk_max_.resize((pairs_.size() + pair_group_grain - 1) / pair_group_grain);
  const auto place = [&](PairLanes::Side& side, std::size_t lane, int node) {
    const auto n = static_cast<std::size_t>(node);
    side.node[lane] = node < 0 ? nothing : &system_.nodes()[n].turn[0];
    side.unknown[lane] = node < 0 ? -1 : node_begin[n];
  };
  for (std::size_t g = 0; g < pairs_.size(); ++g)
    for (std::size_t l = 0; l < nodes_in_lanes; ++l) {
      const NodePair& pair = pairs[std::min(g * nodes_in_lanes + l, pairs.size() - 1)];
      place(pairs_[g].a, l, pair.a);
      place(pairs_[g].b, l, pair.b);
      pairs_[g].per_length.set(static_cast<int>(l), pair.per_length);
    }
}

/// H <- H exp(eta)
void PlanarStep::MoverLanes::move(const Vec3<Pack>& eta) {
  const Vec<Pack, 8> c = motion::eval_stumpff(Pack(eta[2] * eta[2]));
  const Vec2<Pack> e{{c[0], eta[2] * c[1]}}, f{{c[1], eta[2] * c[2]}};
  const Vec2<Pack> step = motion::complex_times(turn, motion::complex_times(f, plane_part(eta)));
  for (int i = 0; i < 2; ++i) {
    Pack s, error;
    motion::two_sum(x.hi[i], step[i], s, error);
    motion::two_sum(s, Pack(x.lo[i] + error), x.hi[i], x.lo[i]);
  }
  turn = motion::complex_times(turn, e);
  turn = Pack(1.5 - 0.5 * lanes::dot(turn, turn)) * turn;  // back to size one, to first order
}

/// dq <- log(H_start^-1 H) after the angle, which is known beyond half a turn, has grown by eta_w.
void PlanarStep::MoverLanes::follow(const StartLanes& start, const Pack& eta_w) {
  Vec2<Pack> way;
  for (int i = 0; i < 2; ++i) {
    Pack s, error;
    motion::two_sum(x.hi[i], Pack(-start.x.hi[i]), s, error);
    way[i] = s + (error + (x.lo[i] - start.x.lo[i]));
  }
  const Pack angle = dq[2] + eta_w;
  const Vec2<Pack> inverse{{motion::half_cotangent(Pack(angle * angle)), -0.5 * angle}};
  dq = motion::join(motion::complex_times(inverse, motion::conjugate_times(start.turn, way)), angle);
}

/// Of nodes in a group.
std::size_t PlanarStep::count_of(std::size_t group) const {
  return std::min(nodes_in_lanes, plan_.nodes.size() - group * nodes_in_lanes);
}

void PlanarStep::enter(const State& start, const AlphaRule& rule, const tree::Walker& walker) {
  rule_ = rule;
  is_under_way_ = true;
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    Pack turned(0.0);
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g)
      enter_nodes(start, g, turned);
    turn_max_[static_cast<std::size_t>(begin / group_grain)] = largest_of(turned);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
}

void PlanarStep::enter_nodes(const State& start, std::size_t group, Pack& turned) {
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<double>& origin = plan_.planar->origin;
  const std::size_t from = group * nodes_in_lanes, count = count_of(group);
  SpaceLanes node;
  Vec6<Pack> algorithmic, trend;
  gather<numbers_before_increment>(start.nodes.data(), from, count, node.R.m);
  gather<6>(start.algorithmic.data(), from, count, algorithmic.v);
  gather<6>(start.acceleration_trend.data(), from, count, trend.v);
  const Mat3<Pack>& B = bases_[group];
  // As PlanarSystem::set_nodes.
  StartLanes& s = starts_[group];
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
  s.trend = in_plane(B, trend);
  const Vec3<Pack> eta = rule_.predict(s.v, s.a, s.algorithmic, start.follows_trend ? s.trend : Vec3<Pack>::zero());
  MoverLanes& mover = movers_[group];
  mover = {s.turn, s.x, eta};
  mover.move(eta);
  show_nodes(group, turned);
}

double PlanarStep::apply(const double* x, const tree::Walker& walker) {
  auto by_pair = [&](std::int64_t begin, std::int64_t end) {
    chunk_max_[static_cast<std::size_t>(begin / pair_group_grain)] = largest_change(x, begin, end);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(pairs_.size()), pair_group_grain, tree::make_chunk(by_pair));
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    Pack turned(0.0);
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) {
      const Vec3<Pack> eta = gather_increments(x, unknowns_.data() + g * nodes_in_lanes);
      MoverLanes& mover = movers_[g];
      mover.move(eta);
      mover.follow(starts_[g], eta[2]);
      show_nodes(g, turned);
    }
    turn_max_[static_cast<std::size_t>(begin / group_grain)] = largest_of(turned);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
  double most = 0.0;
  for (const double size : chunk_max_) most = std::max(most, size);
  return std::sqrt(most);
}

/// The largest square of a shift or a turn of pairs [8 begin, 8 end); infinite where one is too far.
double PlanarStep::largest_change(const double* x, std::int64_t begin, std::int64_t end) const {
  struct Moving {
    Vec2<Pack> turn, x;
    Vec3<Pack> change;  ///< turned into the plane's axes
  };
  const auto look_at = [x](const PairLanes::Side& side) {
    Moving m;
    lanes::gather_lanes(side.node, 4, &m.turn[0]);
    const Vec3<Pack> eta = gather_increments(x, side.unknown);
    m.change = motion::join(motion::complex_times(m.turn, plane_part(eta)), eta[2]);
    return m;
  };
  const Pack far(too_far);
  Pack most(0.0);
  lanes::Mask<elements::num_lanes> near = less(most, far);  // in no lane where something is not a number
  for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) {
    const PairLanes& p = pairs_[g];
    const Moving a = look_at(p.a), b = look_at(p.b);
    const Vec2<Pack> swing = a.change[2] * motion::quarter_turn(Vec2<Pack>(b.x - a.x));
    const Vec3<Pack> change = b.change - motion::join(Vec2<Pack>(plane_part(a.change) + swing), a.change[2]);
    const Vec2<Pack> shift = p.per_length * plane_part(change);
    for (const Pack& size : {shift[0], shift[1], change[2]}) near = near & less(lanes::abs(size), far);
    most = larger(most, larger(lanes::dot(shift, shift), change[2] * change[2]));
  }
  return all(near) ? largest_of(most) : std::numeric_limits<double>::infinity();
}

/// The nodes of a group as elements see them, with velocities and accelerations by the rule. turned: the largest |dq_w| so far, by lane.
void PlanarStep::show_nodes(std::size_t group, Pack& turned) {
  const StartLanes& start = starts_[group];
  const MoverLanes& mover = movers_[group];
  const AlphaRule::Rates<Vec3<Pack>> rates = rule_.follow(mover.dq, start.v, start.a, start.algorithmic);
  const PlanarNodeLanes n{mover.turn, mover.x, rates.v, rates.a, mover.dq};
  scatter<elements::planar::numbers_of_node>(&n.turn[0], system_.nodes().data(), group * nodes_in_lanes,
                                             count_of(group));
  turned = larger(turned, lanes::abs(mover.dq[2]));
}

int PlanarStep::turned_beyond(double angle) const {
  if (std::all_of(turn_max_.begin(), turn_max_.end(), [angle](double turn) { return turn <= angle; })) return -1;
  const std::vector<elements::planar::Node>& nodes = system_.nodes();
  const auto far = std::find_if(nodes.begin(), nodes.end(),
                                [angle](const elements::planar::Node& n) { return std::abs(n.dq[2]) > angle; });
  return far == nodes.end() ? -1 : static_cast<int>(far - nodes.begin());
}

std::int64_t PlanarStep::first_folded(const tree::Walker& walker) const {
  FirstBad first_bad(static_cast<std::int64_t>(plan_.directory.size()));
  const auto turn_of = [this](int node) {
    return node == elements::ground ? Vec2<double>{{1.0, 0.0}} : system_.nodes()[static_cast<std::size_t>(node)].turn;
  };
  auto by_ends = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const BeamEnds& e = beam_ends_[k];
      if (lanes::dot(turn_of(e.a), motion::complex_times(turn_of(e.b), e.between)) < folded)
        return first_bad.note(e.element);
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(beam_ends_.size()), element_grain, tree::make_chunk(by_ends));
  return first_bad.get();
}

void PlanarStep::leave(const State& start, State& state, double arm, std::vector<Workspace::Trend>& trends,
                       const tree::Walker& walker) {
  is_under_way_ = false;
  const std::size_t count = plan_.nodes.size();
  state.nodes.resize(count);
  state.rotation.resize(count);
  state.algorithmic.resize(count);
  state.acceleration_trend.resize(count);
  trends.resize(turn_max_.size());
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    Workspace::Trend trend;
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g)
      leave_nodes(start, state, arm, g, trend);
    trends[static_cast<std::size_t>(begin / group_grain)] = trend;
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
}

void PlanarStep::leave_nodes(const State& start, State& state, double arm, std::size_t group,
                             Workspace::Trend& trend) const {
  const std::size_t from = group * nodes_in_lanes, count = count_of(group);
  const StartLanes& s = starts_[group];
  const MoverLanes& node = movers_[group];
  const Mat3<Pack>& B = bases_[group];
  SpaceLanes to;
  Pack turn[4];
  gather<8>(start.nodes.data(), from, count, &to.x.hi[0], numbers_before_place);  // and two that are written below
  gather<4>(start.rotation.data(), from, count, turn);
  const AlphaRule::Rates<Vec3<Pack>> rates = rule_.follow(node.dq, s.v, s.a, s.algorithmic);
  to.v = in_space(B, rates.v);
  to.a = in_space(B, rates.a);
  to.dq = in_space(B, node.dq);
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
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<Pack> along[2] = {lanes::cast<Pack>(lanes::column(axes, 0)), lanes::cast<Pack>(lanes::column(axes, 1))};
  for (const Vec2<Pack>& part : {hi, lo}) to.x.add(part[0] * along[0] + part[1] * along[1]);
  const Vec3<Pack> change = rates.a - s.a, bend = change - s.trend;
  const auto size = [arm](const Vec3<Pack>& a) {
    return Pack(lanes::dot(plane_part(a), plane_part(a)) + arm * arm * a[2] * a[2]);
  };
  const Pack from_start = size(change), from_trend = size(bend);
  for (std::size_t l = 0; l < count; ++l) {
    trend.from_start += from_start[static_cast<int>(l)];
    trend.from_trend += from_trend[static_cast<int>(l)];
  }
  scatter<numbers_of_motion>(to.R.m, state.nodes.data(), from, count);
  scatter<4>(turn, state.rotation.data(), from, count);
  scatter<6>(in_space(B, rates.algorithmic).v, state.algorithmic.data(), from, count);
  scatter<6>(in_space(B, change).v, state.acceleration_trend.data(), from, count);
}

}  // namespace bough::step
