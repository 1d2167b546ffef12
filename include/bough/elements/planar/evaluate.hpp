#pragma once
/// Names of the elements that move in a plane, on SE(2): three unknowns a node. A node's planar frame is its own turned about fixed axes so
/// that the third is normal to the plane (plan::NodeUnknowns), positions are coordinates in the plane.
#include "bough/elements/evaluate_lanes.hpp"

namespace bough::elements::planar {

using motion::Se2;
using Port = PortOn<Se2, double>;
using Node = NodeMotionOn<Se2, double>;
using NodeLanes = NodeMotionOn<Se2, LanePack>;
using Field = FieldOn<Se2, double>;
using FieldLanes = FieldOn<Se2, LanePack>;

template <int N>
using Beam = BeamOn<Se2, N, double>;
template <int N>
using LineLoad = LineLoadOn<Se2, N, double>;
using RigidBody = RigidBodyOn<Se2, double>;
using PointLoad = PointLoadOn<Se2, double>;
using Spring = SpringOn<Se2, double>;
using Bushing = BushingOn<Se2, double>;
using Joint = JointOn<Se2, double>;

inline constexpr int numbers_of_node = 15;
static_assert(sizeof(Node) == numbers_of_node * sizeof(double));
static_assert(sizeof(NodeLanes) == numbers_of_node * sizeof(LanePack));

}  // namespace bough::elements::planar
