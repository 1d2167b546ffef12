#include "planar_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node_lanes.hpp"
#include "system_parts.hpp"

namespace bough::step {

using lanes::Vec;
using motion::Mat3;
using motion::plane_part;
using motion::Vec2;
using motion::Vec3;

namespace {

using Pack = elements::LanePack;
using PlanarNodeLanes = elements::NodeMotionOn<motion::Se2, elements::LanePack>;
static_assert(elements::num_lanes == static_cast<int>(nodes_in_lanes));
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
Vec2<double> own_turn(const elements::PortOn<motion::Se2, double>& p) {
  return p.node == elements::ground || p.has_offset ? p.offset.R : Vec2<double>{{1.0, 0.0}};
}

Pack larger(const Pack& a, const Pack& b) { return select(less(a, b), b, a); }
double largest_of(const Pack& a) {
  double most = a[0];
  for (int l = 1; l < elements::num_lanes; ++l) most = std::max(most, a[l]);
  return most;
}

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
  read_.resize(groups);
  unknowns_ = node_begin;
  unknowns_.resize(groups * nodes_in_lanes, node_begin.empty() ? -1 : node_begin.back());
  turn_max_.resize((groups + group_grain - 1) / group_grain);
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.planar->elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (E::role == elements::Role::joint)
        if (std::any_of(e.ports, e.ports + E::num_ports, [this](const auto& p) { return moves(p.node); }) &&
            std::any_of(e.rows, e.rows + e.num_rows,
                        [](const auto& row) { return row.kind != elements::RowKind::along; }))
          joints_with_angles_.push_back(static_cast<int>(id));
      if constexpr (E::role == elements::Role::beam)
        for (int i = 1; i < E::num_ports; ++i) beam_ends_.push_back(ends_of(e, static_cast<std::int64_t>(id), i));
    });
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (plan.joints[j].counts_turns) watch_turns(j);
}

template <class E>
PlanarStep::Ends PlanarStep::ends_of(const E& e, std::int64_t owner, int port) {
  return {owner, e.ports[0].node, e.ports[port].node,
          motion::conjugate_times(own_turn(e.ports[0]), own_turn(e.ports[port]))};
}

Vec2<double> PlanarStep::turn_of(int node) const {
  return node == elements::ground ? Vec2<double>{{1.0, 0.0}} : system_.nodes()[static_cast<std::size_t>(node)].R;
}

void PlanarStep::watch_turns(std::size_t joint) {
  const plan::Plan& plan = plan_;
  const plan::ElementPlace& at = plan.directory[static_cast<std::size_t>(plan.joints[joint].element)];
  double sign = 0.0;  // where the axis lies in the plane nothing turns about it
  plan::with_element(plan.elements, at, [&](const auto& e) {
    const elements::Port& p = e.ports[0];
    const Mat3<double> R =
        p.node == elements::ground ? p.offset.R : plan.nodes[static_cast<std::size_t>(p.node)].pose.R * p.offset.R;
    const double along = lanes::dot(lanes::column(R, 2), lanes::column(plan.planar->axes, 2));
    if (std::abs(along) > 0.5) sign = along > 0.0 ? 1.0 : -1.0;
  });
  plan::with_element(plan.planar->elements, at, [&](const auto& e) {
    if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint)
      if (sign != 0.0) turn_counters_.push_back({ends_of(e, static_cast<std::int64_t>(joint), 1), sign});
  });
}

void PlanarStep::count_turns(State& state, const tree::Walker& walker) const {
  constexpr double whole = 6.283185307179586476925;
  auto by_joint = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const TurnCounter& c = turn_counters_[k];
      const Vec2<double> turn =
          motion::conjugate_times(turn_of(c.ends.a), motion::complex_times(turn_of(c.ends.b), c.ends.between));
      const double angle = c.sign * motion::angle_of(turn[0], turn[1]);
      double& turns = state.turns[static_cast<std::size_t>(c.ends.owner)];
      turns = angle + whole * std::round((turns - angle) / whole);  // of those half a turn from the last the nearest
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(turn_counters_.size()), element_grain, tree::make_chunk(by_joint));
}

void PlanarStep::place_pairs(const std::vector<NodePair>& pairs, const std::vector<std::int64_t>& node_begin) {
  pairs_.resize((pairs.size() + nodes_in_lanes - 1) / nodes_in_lanes);
  chunk_max_.resize((pairs_.size() + pair_group_grain - 1) / pair_group_grain);
  const auto place = [&](PairLanes::Side& side, std::size_t lane, int node) {
    const auto n = static_cast<std::size_t>(node);
    side.node[lane] = node < 0 ? nothing : &system_.nodes()[n].R[0];
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

void PlanarStep::enter(const State& start, bool is_end, const AlphaRule& rule, const tree::Walker& walker) {
  rule_ = rule;
  is_under_way_ = true;
  const bool reads = !is_end || number_ == 0;
  if (reads) ++number_;  // what was left behind before is lost
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    Pack turned(0.0);
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) {
      if (reads) read_nodes(start, g);
      const StartLanes& s = starts_[g];
      const Vec3<Pack> change = predicted_change(start.predictor_order, s.trend, s.trend_change);
      const Vec3<Pack> eta = rule_.predict(s.v, s.a, s.algorithmic, change);
      MoverLanes& mover = movers_[g];
      mover = {s.turn, s.x, eta};
      mover.move(eta);
      show_nodes(g, turned);
    }
    turn_max_[static_cast<std::size_t>(begin / group_grain)] = largest_of(turned);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
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
  scatter<elements::numbers_of_node<motion::Se2>>(&n.R[0], system_.nodes().data(), group * nodes_in_lanes,
                                                  count_of(group));
  turned = larger(turned, lanes::abs(mover.dq[2]));
}

int PlanarStep::turned_beyond(double angle) const {
  if (std::all_of(turn_max_.begin(), turn_max_.end(), [angle](double turn) { return turn <= angle; })) return -1;
  const std::vector<elements::NodeMotionOn<motion::Se2, double>>& nodes = system_.nodes();
  const auto far =
      std::find_if(nodes.begin(), nodes.end(),
                   [angle](const elements::NodeMotionOn<motion::Se2, double>& n) { return std::abs(n.dq[2]) > angle; });
  return far == nodes.end() ? -1 : static_cast<int>(far - nodes.begin());
}

std::int64_t PlanarStep::first_folded(const tree::Walker& walker) const {
  FirstBad first_bad(static_cast<std::int64_t>(plan_.directory.size()));
  auto by_ends = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const Ends& e = beam_ends_[k];
      if (lanes::dot(turn_of(e.a), motion::complex_times(turn_of(e.b), e.between)) < folded)
        return first_bad.note(e.owner);
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(beam_ends_.size()), element_grain, tree::make_chunk(by_ends));
  return first_bad.get();
}

void PlanarStep::finish(double arm, std::vector<Workspace::StepEnd>& ends, const tree::Walker& walker) {
  is_under_way_ = false;
  ++number_;
  ends.resize(turn_max_.size());
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    Workspace::StepEnd part;
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) finish_nodes(arm, g, part);
    ends[static_cast<std::size_t>(begin / group_grain)] = part;
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
}

void PlanarStep::finish_nodes(double arm, std::size_t group, Workspace::StepEnd& end) {
  StartLanes& s = starts_[group];
  const MoverLanes& node = movers_[group];
  const AlphaRule::Rates<Vec3<Pack>> rates = rule_.follow(node.dq, s.v, s.a, s.algorithmic);
  const Vec3<Pack> change = rates.a - s.a, of_trend = change - s.trend;
  const auto size = [arm](const Vec3<Pack>& a) {
    return Pack(lanes::dot(plane_part(a), plane_part(a)) + arm * arm * a[2] * a[2]);
  };
  const Pack miss[] = {size(change), size(of_trend), size(of_trend - s.trend_change)};
  for (std::size_t k = 0; k < end.misses.size(); ++k)
    for (std::size_t l = 0; l < count_of(group); ++l) end.misses[k] += miss[k][static_cast<int>(l)];
  const Pack per_length(1.0 / plan_.length_scale);
  const auto largest = [&per_length](const Vec3<Pack>& v) {
    return largest_of(larger(per_length * larger(lanes::abs(v[0]), lanes::abs(v[1])), lanes::abs(v[2])));
  };
  end.error = std::max(
      end.error, largest(rule_.local_error(change, motion::Se2::widened(motion::Se2::bracket(rates.v, rates.a)))));
  end.increment = std::max(end.increment, largest(node.dq));
  s = {node.turn, node.x, rates.v, rates.a, change, of_trend, rates.algorithmic, node.dq};
}

}  // namespace bough::step
