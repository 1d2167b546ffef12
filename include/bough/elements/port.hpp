#pragma once
/// A port is the frame at which an element is attached to the structure. This file defines ports and the motions that
/// an element receives at them.
#include <cstdint>

#include "bough/lanes/jet.hpp"
#include "bough/motion/group.hpp"

namespace bough::elements {

using lanes::Mat;
using lanes::Vec;
using motion::Frame;
using motion::Mat3;
using motion::Mat6;
using motion::Vec3;
using motion::Vec6;

constexpr int ground = -1;  ///< node index of the ground, which is fixed in space

/// A frame fixed to a node, at `offset` in the node's axes. With node == ground, `offset` is the pose in the ground, or
/// in a frame of prescribed motion (carrier). The constants of elements have type C: double, or a pack that holds the
/// constants of several elements, one to a lane.
template <class G, class C>
struct PortOn {
  int node = ground;
  bool has_offset = false;  ///< false: the offset is the identity and is not applied
  typename G::template Pose<C> offset = G::template Pose<C>::identity();
  int carrier =
      -1;  ///< node == ground: index of a frame in Field::carriers, the same in all lanes; -1: the ground itself
};
template <class C>
using PortOf = PortOn<motion::Se3, C>;
using Port = PortOf<double>;

/// The role of an element in a model. The rest of the library asks for the role and never for the element's type.
enum class Role : std::uint8_t {
  body,      ///< mass at one frame
  beam,      ///< material along a reference axis between nodes
  coupling,  ///< acts between two frames without constraints
  joint,     ///< rows of constraints between two frames, and efforts along what they leave free
  load,      ///< given forces
};
/// Whether an element connects two frames.
constexpr bool joins_two_frames(Role role) { return role == Role::coupling || role == Role::joint; }

/// Whether an element of type E can live on its group. False for those that resist rotations, on groups without
/// rotations.
template <class E>
inline constexpr bool exists = true;

/// Axes in which the data of an element are given.
enum class DataAxes : std::uint8_t {
  none,     ///< there are none: every port may be turned by itself
  port,     ///< those of the first port
  section,  ///< the same, and axis 1 is the reference axis
};

/// Seconds of one evaluation of an element in space, alone and as one of eight lanes: residual, and residual with
/// tangent. For decisions and predictions of run times, in which only ratios count; measured by bench_elements on the
/// machine of src/elements/README.md.
struct Cost {
  double alone, alone_tangent, lane, lane_tangent;
};
/// Cost of a residual on a group relative to one in space, fitted by hand: in a plane to steps of chains and lattices
/// (bench_step, bench_lean), where nothing turns to springs in lanes (bench_elements).
template <class G>
inline constexpr double residual_part = 1.0;
template <>
inline constexpr double residual_part<motion::Se2> = 0.37;
template <>
inline constexpr double residual_part<motion::Translations<3>> = 0.4;
template <>
inline constexpr double residual_part<motion::Translations<1>> = 0.2;
inline constexpr Cost small_cost{60e-9, 200e-9, 15e-9, 60e-9};  ///< of bodies, springs and point loads

/// Whether a constant contributes, so that its terms have to be computed. A pack contributes if one of its lanes does:
/// for the other lanes the terms are zero times a finite number and add nothing.
inline bool is_present(double x) { return x != 0.0; }
template <class C>
bool is_present(const C& x) {
  return any(less(C(0.0), abs(x)));
}

/// Prescribed motion of a frame at one instant: pose, twist in its own axes and the twist's first two derivatives,
/// component by component.
template <class S>
struct CarrierMotionOf {
  Frame<S> pose = Frame<S>::identity();
  Vec6<S> twist = Vec6<S>::zero();
  Vec6<S> twist_rate = Vec6<S>::zero();
  Vec6<S> twist_second = Vec6<S>::zero();  ///< used by constraint series and rates only
};
using CarrierMotion = CarrierMotionOf<double>;

/// Motion of a port's frame as a kernel sees it, on the group G.
///   H: pose, its position relative to the element's anchor (differences keep their digits far from the origin) [m]
///   v: twist (linear; angular) in the port's own axes [m/s, rad/s];  a: its time derivative, component by component.
template <class G, class S>
struct PortMotionOn {
  typename G::template Pose<S> H;
  typename G::template Vector<S> v, a;
};
template <class S>
using PortMotion = PortMotionOn<motion::Se3, S>;

/// Motion with respect to the inertial frame of a port whose motion p is known in a frame that itself moves with the
/// twist V (in its own axes):
///   v + c,  a + Ad(H^-1) V' - ad(v) c,  c = Ad(H^-1) V                    (the middle of ad(v) c is the Coriolis term)
/// The pose remains the one in the moving frame: forces depend on relative poses and on the direction of gravity, which
/// is transformed to that frame. anchor: the origin of p.H.x [m].
template <class S>
void add_observer_motion(PortMotion<S>& p, const Vec3<S>& anchor, const Vec6<S>& twist, const Vec6<S>& twist_rate) {
  const Frame<S> H{p.H.R, p.H.x + anchor};
  const Vec6<S> carried = motion::inverse_adjoint_times(H, twist);
  p.a += motion::inverse_adjoint_times(H, twist_rate) - motion::cross6_times(p.v, carried);
  p.v += carried;
}

/// Scalar type of quantities by which an element's forces are never differentiated: constants, laws, multipliers.
template <class S>
struct ConstantOf {
  using Type = S;
};
template <class S, int N>
struct ConstantOf<lanes::Jet<S, N>> {
  using Type = S;
};
template <class S>
using Constant = typename ConstantOf<S>::Type;

/// Quantities that are common to all elements at one instant.
template <class G, class S>
struct SurroundingsOn {
  typename G::template Translation<S> gravity;  ///< acceleration in inertial axes [m/s^2]
  const Constant<S>* laws = nullptr;            ///< value of each time function
  bool has_inertia = true;                      ///< false in statics, where velocities and accelerations are not used
};
template <class S>
using Surroundings = SurroundingsOn<motion::Se3, S>;

/// How a port's motion follows its increment eta: H <- H exp(eta) if `moves`, dv = velocity eta, da = acceleration eta.
/// `moves` is the same for all ports of an element; the columns of ports on the ground are dropped afterwards.
template <class G, class S>
struct PortSlopesOn {
  bool moves = true;
  typename G::template Map<S> velocity, acceleration;
};

/// Defaults for elements that declare nothing else: whether they have mass, and how much [kg]; whether they dissipate
/// energy (an element without mass whose forces depend on velocities is a damper); the law by which their strain energy
/// is multiplied, -1: none, which does work as it changes, the energy at the value 1 times its change; whether they
/// exchange energy with the outside, as loads do.
template <class E>
bool has_mass(const E&) {
  return false;
}
template <class E>
double total_mass(const E&) {
  return 0.0;
}
template <class E>
bool dissipates(const E& e) {
  return E::role != Role::body && looks_at_rates(e);
}
template <class E>
int stiffness_law(const E&) {
  return -1;
}
template <class E>
bool exchanges_energy(const E& e) {
  return E::role == Role::load || dissipates(e) || stiffness_law(e) >= 0;
}

/// Of one element, for the balances of a run.
struct Measures {
  double dissipation_rate = 0.0;  ///< taken by dampers, >= 0 [W]
  double strain_by_law = 0.0;     ///< derivative of the strain energy by stiffness_law [J]
  /// Resultant of loads and reactions of the ground, and its moment about the inertial origin [N, N m].
  Vec3<double> force = Vec3<double>::zero(), moment = Vec3<double>::zero();
};

}  // namespace bough::elements
