/// Conversion of nodes on other groups to nodes in space, eight at a time.
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
using motion::Se3;

/// Initial poses of eight nodes, on the group and in space.
template <class G>
struct Start {
  Mat3<Pack> basis;
  motion::Quaternion<Pack> rotation;
  motion::PositionPair<Pack> place;
  [[no_unique_address]] typename G::template Rotation<Pack> turn;
  motion::PositionPair<Pack, G::translations> x;
};
constexpr std::int64_t nodes_of_chunk = 8 * static_cast<std::int64_t>(nodes_in_lanes);
template <class G>
inline constexpr int start_numbers = sizeof(plan::NodeStartOn<G>) / sizeof(double);

/// A motion vector of a node as one in space, in the node's own axes. The leading columns of B are along the
/// translations of the group, the third is the axis of rotations.
template <class G>
Vec6<Pack> in_space(const Mat3<Pack>& B, const typename G::template Vector<Pack>& z) {
  Vec6<Pack> v;
  for (int i = 0; i < 3; ++i) {
    v[i] = B(i, 0) * z[0];
    for (int k = 1; k < G::translations; ++k) v[i] = v[i] + B(i, k) * z[k];
    if constexpr (G::turns)
      v[3 + i] = B(i, 2) * z[2];
    else
      v[3 + i] = Pack(0.0);
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

/// Rotation in space: in a plane a turn about the normal since the start. The quaternion is normalised to first order.
Mat3<Pack> rotation_in_space(const Start<motion::Se2>& start, const Vec2<Pack>& turn) {
  const Vec2<Pack> half = half_turn(motion::conjugate_times(start.turn, turn));
  motion::Quaternion<Pack> turned =
      motion::multiply(start.rotation, motion::Quaternion<Pack>{half[0], Vec3<Pack>(half[1] * column(start.basis, 2))});
  const Pack unit = 1.5 - 0.5 * (turned.w * turned.w + lanes::dot(turned.v, turned.v));
  turned = {unit * turned.w, Vec3<Pack>(unit * turned.v)};
  return motion::rotation_of(turned);
}
template <class G>
Mat3<Pack> rotation_in_space(const Start<G>& start, motion::NoRotation) {
  return motion::rotation_of(start.rotation);
}

template <class G>
elements::NodeLanes show(const Mat3<double>& axes, const Start<G>& start, const elements::NodeMotionOn<G, Pack>& node) {
  elements::NodeLanes to;
  to.R = rotation_in_space(start, node.R);
  // The position is converted as a displacement in two parts, which keeps the digits beyond double precision.
  typename G::template Translation<Pack> hi, lo;
  for (int i = 0; i < G::translations; ++i) {
    motion::two_sum(node.x.hi[i], Pack(-start.x.hi[i]), hi[i], lo[i]);
    lo[i] = lo[i] + (node.x.lo[i] - start.x.lo[i]);
  }
  to.x = start.place;
  for (const auto& part : {hi, lo}) {
    Vec3<Pack> step = part[0] * lanes::cast<Pack>(column(axes, 0));
    for (int i = 1; i < G::translations; ++i) step = step + part[i] * lanes::cast<Pack>(column(axes, i));
    to.x.add(step);
  }
  to.v = in_space<G>(start.basis, node.v);
  to.a = in_space<G>(start.basis, node.a);
  to.dq = in_space<G>(start.basis, node.dq);
  to.drift = Vec3<Pack>::zero();
  if constexpr (G::turns) {
    auto drift = G::template Vector<Pack>::zero();
    for (int i = 0; i < G::translations; ++i) drift[i] = node.drift[i];
    to.drift = lanes::linear_part(in_space<G>(start.basis, drift));
  }
  return to;
}

/// Converts the nodes node(k) for k = first to end - 1.
template <class G, class Node>
void show_nodes(const plan::Plan& plan, const NodesOn<G>& nodes, std::size_t first, std::size_t end, Node&& node,
                std::vector<elements::NodeMotion>& to) {
  static_assert(sizeof(Start<G>) == start_numbers<G> * sizeof(Pack));
  const plan::ModelOn<G>& model = std::get<plan::ModelOn<G>>(plan.model);
  for (; first < end; first += nodes_in_lanes) {
    const double *starts[nodes_in_lanes], *motions[nodes_in_lanes];
    double* shown[nodes_in_lanes];
    for (std::size_t l = 0; l < nodes_in_lanes; ++l) {  // unused lanes repeat the last node
      const std::size_t n = node(std::min(first + l, end - 1));
      starts[l] = reinterpret_cast<const double*>(&model.nodes[n]);
      motions[l] = reinterpret_cast<const double*>(&nodes.motion[n]);
      shown[l] = reinterpret_cast<double*>(&to[n]);
    }
    Start<G> start;
    elements::NodeMotionOn<G, Pack> motion;
    lanes::gather_lanes(starts, start_numbers<G>, reinterpret_cast<Pack*>(&start));
    lanes::gather_lanes(motions, elements::numbers_of_node<G>, reinterpret_cast<Pack*>(&motion));
    const elements::NodeLanes in_space = show(plan.axes, start, motion);
    lanes::scatter_lanes(reinterpret_cast<const Pack*>(&in_space), elements::numbers_of_node<Se3>, shown);
  }
}

}  // namespace

const std::vector<elements::NodeMotion>& nodes_in_space(const plan::Plan& plan, const State& state) {
  return state.visit([&]<class G>(const NodesOn<G>& nodes) -> const std::vector<elements::NodeMotion>& {
    if constexpr (std::is_same_v<G, Se3>) {
      return nodes.motion;
    } else {
      std::vector<elements::NodeMotion>& shown = state.in_space_.nodes;
      if (shown.empty()) {
        shown.resize(nodes.motion.size());
        show_nodes(
            plan, nodes, 0, nodes.motion.size(), [](std::size_t k) { return k; }, shown);
      }
      return shown;
    }
  });
}

void copy_nodes_in_space(const plan::Plan& plan, const State& state, std::span<const int> which,
                         std::vector<elements::NodeMotion>& to, const tree::Walker* walker) {
  if (which.empty()) return;
  state.visit([&]<class G>(const NodesOn<G>& nodes) {
    const auto node = [which](std::size_t k) { return static_cast<std::size_t>(which[k]); };
    auto copy = [&](std::int64_t begin, std::int64_t end) {
      if constexpr (std::is_same_v<G, Se3>)
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          to[node(k)] = nodes.motion[node(k)];
      else
        show_nodes(plan, nodes, static_cast<std::size_t>(begin), static_cast<std::size_t>(end), node, to);
    };
    const auto count = static_cast<std::int64_t>(which.size());
    if (walker == nullptr) return copy(0, count);
    walker->for_each_chunk(count, nodes_of_chunk, tree::make_chunk(copy));
  });
}

}  // namespace bough::step
