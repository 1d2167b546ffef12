/// Conversion of nodes that move in a plane to nodes in space, eight at a time.
#include <algorithm>
#include <numeric>

#include "node_lanes.hpp"

namespace bough::step {

using lanes::column;
using motion::Mat3;
using motion::Vec2;
using motion::Vec3;
using motion::Vec6;

namespace {

using Pack = elements::LanePack;
using motion::Se2;
using motion::Se3;

/// Initial poses of eight nodes, in space and in the plane.
struct Start {
  Mat3<Pack> basis;
  motion::Quaternion<Pack> rotation;
  motion::PositionPair<Pack> place;
  Vec2<Pack> turn;
  motion::PositionPair<Pack, 2> x;
};
constexpr int start_numbers = sizeof(plan::PlanarNode) / sizeof(double);
static_assert(sizeof(Start) == start_numbers * sizeof(Pack));

/// A motion vector of a node in the plane as one in space, in the node's own axes. The first two columns of B are along
/// the plane, the third is its normal.
Vec6<Pack> in_space(const Mat3<Pack>& B, const Vec3<Pack>& z) {
  Vec6<Pack> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = B(i, 0) * z[0] + B(i, 1) * z[1];
    v[3 + i] = B(i, 2) * z[2];
  }
  return v;
}

/// Cosine and sine of half of the angle with cosine and sine `turn`, up to a common sign. The larger of the two is
/// computed by a square root, the other from 2 cos(t/2) sin(t/2) = sin t.
Vec2<Pack> half_turn(const Vec2<Pack>& turn) {
  const auto beyond = less(turn[0], Pack(0.0));  // the angle exceeds a quarter of a turn
  const Pack larger = sqrt(Pack(0.5 + 0.5 * lanes::abs(turn[0]))), other = 0.5 * turn[1] / larger;
  return {{select(beyond, other, larger), select(beyond, larger, other)}};
}

elements::NodeLanes show(const plan::PlanarModel& plane, const Start& start,
                         const elements::NodeMotionOn<Se2, Pack>& node) {
  elements::NodeLanes to;
  // Rotation about the normal since the start. The quaternion is normalised to first order.
  const Vec2<Pack> half = half_turn(motion::conjugate_times(start.turn, node.R));
  motion::Quaternion<Pack> turned =
      motion::multiply(start.rotation, motion::Quaternion<Pack>{half[0], Vec3<Pack>(half[1] * column(start.basis, 2))});
  const Pack unit = 1.5 - 0.5 * (turned.w * turned.w + lanes::dot(turned.v, turned.v));
  turned = {unit * turned.w, Vec3<Pack>(unit * turned.v)};
  to.R = motion::rotation_of(turned);
  // The position is converted as a displacement in two parts, which keeps the digits beyond double precision.
  Vec2<Pack> hi, lo;
  for (int i = 0; i < 2; ++i) {
    motion::two_sum(node.x.hi[i], Pack(-start.x.hi[i]), hi[i], lo[i]);
    lo[i] = lo[i] + (node.x.lo[i] - start.x.lo[i]);
  }
  const Vec3<Pack> along[2] = {lanes::cast<Pack>(column(plane.axes, 0)), lanes::cast<Pack>(column(plane.axes, 1))};
  to.x = start.place;
  for (const Vec2<Pack>& part : {hi, lo}) to.x.add(part[0] * along[0] + part[1] * along[1]);
  to.v = in_space(start.basis, node.v);
  to.a = in_space(start.basis, node.a);
  to.dq = in_space(start.basis, node.dq);
  return to;
}

/// Converts the nodes node(k) for k = 0 to count - 1.
template <class Node>
void show_nodes(const plan::PlanarModel& plane, const PlanarNodes& nodes, std::size_t count, Node&& node,
                std::vector<elements::NodeMotion>& to) {
  for (std::size_t first = 0; first < count; first += nodes_in_lanes) {
    const double *starts[nodes_in_lanes], *motions[nodes_in_lanes];
    double* shown[nodes_in_lanes];
    for (std::size_t l = 0; l < nodes_in_lanes; ++l) {  // unused lanes repeat the last node
      const std::size_t n = node(std::min(first + l, count - 1));
      starts[l] = reinterpret_cast<const double*>(&plane.nodes[n]);
      motions[l] = reinterpret_cast<const double*>(&nodes.motion[n]);
      shown[l] = reinterpret_cast<double*>(&to[n]);
    }
    Start start;
    elements::NodeMotionOn<Se2, Pack> motion;
    lanes::gather_lanes(starts, start_numbers, reinterpret_cast<Pack*>(&start));
    lanes::gather_lanes(motions, elements::numbers_of_node<Se2>, reinterpret_cast<Pack*>(&motion));
    const elements::NodeLanes in_space = show(plane, start, motion);
    lanes::scatter_lanes(reinterpret_cast<const Pack*>(&in_space), elements::numbers_of_node<Se3>, shown);
  }
}

}  // namespace

const std::vector<elements::NodeMotion>& nodes_in_space(const plan::Plan& plan, const State& state) {
  if (!state.is_planar()) return state.on<Se3>().motion;
  const PlanarNodes& nodes = state.on<Se2>();
  std::vector<elements::NodeMotion>& shown = state.in_space_.nodes;
  if (shown.empty()) {
    shown.resize(nodes.motion.size());
    show_nodes(
        *plan.planar, nodes, nodes.motion.size(), [](std::size_t k) { return k; }, shown);
  }
  return shown;
}

void copy_nodes_in_space(const plan::Plan& plan, const State& state, std::span<const int> nodes,
                         std::vector<elements::NodeMotion>& to) {
  if (nodes.empty()) return;
  if (state.is_planar())
    return show_nodes(
        *plan.planar, state.on<Se2>(), nodes.size(),
        [nodes](std::size_t k) { return static_cast<std::size_t>(nodes[k]); }, to);
  for (const int n : nodes) to[static_cast<std::size_t>(n)] = state.on<Se3>().motion[static_cast<std::size_t>(n)];
}

}  // namespace bough::step
