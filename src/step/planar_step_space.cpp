/// Nodes of a PlanarStep between the plane and space.
#include <algorithm>
#include <utility>

#include "node_lanes.hpp"
#include "planar_step.hpp"

namespace bough::step {

using lanes::Vec;
using motion::Mat3;
using motion::Vec2;
using motion::Vec3;
using motion::Vec6;

namespace {

using Pack = elements::LanePack;

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

/// Cosine and sine of half the turn (c, s), up to the sign of both: of the larger of the two by a root, of the other by 2 (c/2)(s/2) = s.
Vec2<Pack> half_turn(const Vec2<Pack>& turn) {
  const auto beyond = less(turn[0], Pack(0.0));  // a quarter of a turn
  const Pack larger = sqrt(Pack(0.5 + 0.5 * lanes::abs(turn[0]))), other = 0.5 * turn[1] / larger;
  return {{select(beyond, other, larger), select(beyond, larger, other)}};
}

using SpaceLanes = elements::NodeMotionOf<Pack>;
constexpr int numbers_of_motion = 33, numbers_before_increment = 27;
static_assert(sizeof(elements::NodeMotion) == numbers_of_motion * sizeof(double) &&
              sizeof(SpaceLanes) == numbers_of_motion * sizeof(Pack));

}  // namespace

Trouble lost_nodes(const State& state) {
  return {"nodes at time " + std::to_string(state.time) +
          " were left in the plane: they must be asked for first (System::catch_up), and are lost where another step "
          "was tried since"};
}

void PlanarStep::read_nodes(const State& start, std::size_t group) {
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<double>& origin = plan_.planar->origin;
  const std::size_t from = group * nodes_in_lanes, count = count_of(group);
  SpaceLanes node;
  Pack q[4];
  Vec6<Pack> algorithmic, trend, trend_change;
  gather<numbers_before_increment>(start.nodes.data(), from, count, node.R.m);
  gather<4>(start.rotation.data(), from, count, q);
  gather<6>(start.algorithmic.data(), from, count, algorithmic.v);
  gather<6>(start.acceleration_trend.data(), from, count, trend.v);
  gather<6>(start.trend_change.data(), from, count, trend_change.v);
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
  s.trend_change = in_plane(B, trend_change);
  read_[group] = {node.x, {q[0], {{q[1], q[2], q[3]}}}, s.turn, s.x};
}

void PlanarStep::keep(State& start, State& state) const {
  std::swap(state.nodes, start.nodes);
  std::swap(state.rotation, start.rotation);
  std::swap(state.algorithmic, start.algorithmic);
  std::swap(state.acceleration_trend, start.acceleration_trend);
  std::swap(state.trend_change, start.trend_change);
  state.behind = number_;
}

void PlanarStep::write(State& state, const tree::Walker& walker) {
  const std::size_t count = plan_.nodes.size();
  state.nodes.resize(count);
  state.rotation.resize(count);
  state.algorithmic.resize(count);
  state.acceleration_trend.resize(count);
  state.trend_change.resize(count);
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) write_nodes(state, g);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(starts_.size()), group_grain, tree::make_chunk(by_group));
  state.behind = 0;
}

void PlanarStep::watch(const std::vector<int>& nodes) {
  watched_groups_.clear();
  for (const int n : nodes) watched_groups_.push_back(static_cast<std::size_t>(n) / nodes_in_lanes);
  std::sort(watched_groups_.begin(), watched_groups_.end());
  watched_groups_.erase(std::unique(watched_groups_.begin(), watched_groups_.end()), watched_groups_.end());
}

void PlanarStep::write_watched(State& state, const tree::Walker& walker) {
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      write_nodes(state, watched_groups_[k]);
  };
  walker.for_each_chunk(static_cast<std::int64_t>(watched_groups_.size()), group_grain, tree::make_chunk(by_group));
  state.behind = number_;
}

void PlanarStep::write_nodes(State& state, std::size_t group) const {
  const std::size_t first = group * nodes_in_lanes, count = count_of(group);
  const StartLanes& s = starts_[group];
  const ReadLanes& read = read_[group];
  const Mat3<Pack>& B = bases_[group];
  SpaceLanes to;
  // Turned about the normal since it was read; unit quaternions stay so to first order.
  const Vec2<Pack> half = half_turn(motion::conjugate_times(read.turn, s.turn));
  motion::Quaternion<Pack> turned =
      motion::multiply(read.rotation, motion::Quaternion<Pack>{half[0], Vec3<Pack>(half[1] * lanes::column(B, 2))});
  const Pack unit = 1.5 - 0.5 * (turned.w * turned.w + lanes::dot(turned.v, turned.v));
  turned = {unit * turned.w, Vec3<Pack>(unit * turned.v)};
  to.R = motion::rotation_of(turned);
  const Pack q[4] = {turned.w, turned.v[0], turned.v[1], turned.v[2]};
  // The place itself goes into space as a displacement, so that its digits beyond a double stay.
  Vec2<Pack> hi, lo;
  for (int i = 0; i < 2; ++i) {
    motion::two_sum(s.x.hi[i], Pack(-read.x.hi[i]), hi[i], lo[i]);
    lo[i] = lo[i] + (s.x.lo[i] - read.x.lo[i]);
  }
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<Pack> along[2] = {lanes::cast<Pack>(lanes::column(axes, 0)), lanes::cast<Pack>(lanes::column(axes, 1))};
  to.x = read.place;
  for (const Vec2<Pack>& part : {hi, lo}) to.x.add(part[0] * along[0] + part[1] * along[1]);
  to.v = in_space(B, s.v);
  to.a = in_space(B, s.a);
  to.dq = in_space(B, s.dq);
  scatter<numbers_of_motion>(to.R.m, state.nodes.data(), first, count);
  scatter<4>(q, state.rotation.data(), first, count);
  scatter<6>(in_space(B, s.algorithmic).v, state.algorithmic.data(), first, count);
  scatter<6>(in_space(B, s.trend).v, state.acceleration_trend.data(), first, count);
  scatter<6>(in_space(B, s.trend_change).v, state.trend_change.data(), first, count);
}

}  // namespace bough::step
