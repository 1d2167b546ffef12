#pragma once
/// Bodies of evaluate_lanes.hpp; included in the files that instantiate them.
#include "bough/elements/evaluate_lanes.hpp"
#include "evaluate_impl.hpp"

namespace bough::elements {

/// Each field of an element as visit(field of the first, field of the second): numbers that may differ between lanes.
template <class A, class B, int N, class Visit>
void visit_all(const Vec<A, N>& a, Vec<B, N>& b, const Visit& visit) {
  for (int i = 0; i < N; ++i) visit(a[i], b[i]);
}
template <class A, class B, int R, int C, class Visit>
void visit_all(const Mat<A, R, C>& a, Mat<B, R, C>& b, const Visit& visit) {
  for (int i = 0; i < R * C; ++i) visit(a.m[i], b.m[i]);
}
template <class PoseA, class PoseB, class Visit>
void visit_pose(const PoseA& a, PoseB& b, const Visit& visit) {
  visit_all(a.R, b.R, visit);
  visit_all(a.x, b.x, visit);
}
/// Directions of rows in a plane are numbers, in space they are named by their axes.
template <class A, class B, class Visit>
void visit_direction(const motion::Se3::Direction<A>&, motion::Se3::Direction<B>&, const Visit&) {}
template <class A, class B, class Visit>
void visit_direction(const motion::Se2::Direction<A>& a, motion::Se2::Direction<B>& b, const Visit& visit) {
  visit_all(a.d, b.d, visit);
}
template <class A>
bool has_same_axes(const motion::Se3::Direction<A>& a, const motion::Se3::Direction<A>& b) {
  return a.i == b.i && a.j == b.j;
}
template <class A>
bool has_same_axes(const motion::Se2::Direction<A>&, const motion::Se2::Direction<A>&) {
  return true;
}
template <class A, class B>
void set_axes(const motion::Se3::Direction<A>& a, motion::Se3::Direction<B>& b) {
  b.i = a.i;
  b.j = a.j;
}
template <class A, class B>
void set_axes(const motion::Se2::Direction<A>&, motion::Se2::Direction<B>&) {}
template <class G, int N, class A, class B, class Visit>
void visit_numbers(const BeamOn<G, N, A>& a, BeamOn<G, N, B>& b, const Visit& visit) {
  visit(a.length, b.length);
  visit_all(a.stiffness, b.stiffness, visit);
  visit_all(a.damping, b.damping, visit);
  visit_all(a.mass, b.mass, visit);
  for (int g = 0; g < N - 1; ++g) visit_all(a.reference_strain[g], b.reference_strain[g], visit);
}
template <class G, int N, class A, class B, class Visit>
void visit_numbers(const LineLoadOn<G, N, A>& a, LineLoadOn<G, N, B>& b, const Visit& visit) {
  visit(a.length, b.length);
  visit_all(a.wrench, b.wrench, visit);
}
template <class G, class A, class B, class Visit>
void visit_numbers(const RigidBodyOn<G, A>& a, RigidBodyOn<G, B>& b, const Visit& visit) {
  visit_all(a.mass, b.mass, visit);
}
template <class G, class A, class B, class Visit>
void visit_numbers(const PointLoadOn<G, A>& a, PointLoadOn<G, B>& b, const Visit& visit) {
  visit_all(a.wrench, b.wrench, visit);
}
template <class G, class A, class B, class Visit>
void visit_numbers(const SpringOn<G, A>& a, SpringOn<G, B>& b, const Visit& visit) {
  visit(a.stiffness, b.stiffness);
  visit(a.rest_length, b.rest_length);
  visit(a.damping, b.damping);
}
template <class G, class A, class B, class Visit>
void visit_numbers(const BushingOn<G, A>& a, BushingOn<G, B>& b, const Visit& visit) {
  visit_all(a.stiffness, b.stiffness, visit);
  visit_all(a.damping, b.damping, visit);
  visit_all(a.rest, b.rest, visit);
}
template <class G, class A, class B, class Visit>
void visit_numbers(const JointOn<G, A>& a, JointOn<G, B>& b, const Visit& visit) {
  for (int k = 0; k < a.num_rows; ++k) {
    visit_direction(a.rows[k], b.rows[k], visit);
    visit(a.rows[k].pitch, b.rows[k].pitch);
  }
  for (int k = 0; k < a.num_efforts; ++k) {
    visit_direction(a.efforts[k].direction, b.efforts[k].direction, visit);
    visit(a.efforts[k].stiffness, b.efforts[k].stiffness);
    visit(a.efforts[k].rest, b.efforts[k].rest);
    visit(a.efforts[k].damping, b.efforts[k].damping);
  }
}

/// Terms that an element has: the same for all lanes.
template <class G, int N>
bool is_same_kind(const BeamOn<G, N>& a, const BeamOn<G, N>& b) {
  return a.has_damping == b.has_damping && a.has_mass == b.has_mass;
}
template <class G, int N>
bool is_same_kind(const LineLoadOn<G, N>& a, const LineLoadOn<G, N>& b) {
  return a.follows == b.follows;
}
template <class G>
bool is_same_kind(const RigidBodyOn<G, double>& a, const RigidBodyOn<G, double>& b) {
  return a.is_point == b.is_point;
}
template <class G>
bool is_same_kind(const PointLoadOn<G, double>& a, const PointLoadOn<G, double>& b) {
  return a.follows == b.follows;
}
template <class G>
bool is_same_kind(const SpringOn<G, double>&, const SpringOn<G, double>&) {
  return true;
}
template <class G>
bool is_same_kind(const BushingOn<G, double>& a, const BushingOn<G, double>& b) {
  return a.has_damping == b.has_damping;
}
template <class G>
bool is_same_kind(const JointOn<G, double>& a, const JointOn<G, double>& b) {
  if (a.num_rows != b.num_rows || a.num_efforts != b.num_efforts) return false;
  for (int k = 0; k < a.num_rows; ++k) {
    const auto &p = a.rows[k], &q = b.rows[k];
    if (p.kind != q.kind || !has_same_axes(p, q) || (p.law < 0) != (q.law < 0)) return false;
  }
  for (int k = 0; k < a.num_efforts; ++k) {
    const auto &p = a.efforts[k], &q = b.efforts[k];
    if (p.coordinate != q.coordinate || !has_same_axes(p.direction, q.direction) || (p.law < 0) != (q.law < 0))
      return false;
  }
  return true;
}

/// Copies the kind and renumbers the laws from `law` on.
template <class G, int N>
void set_kind(const BeamOn<G, N>& a, BeamOn<G, N, LanePack>& b, int) {
  b.has_damping = a.has_damping;
  b.has_mass = a.has_mass;
}
template <class G, int N>
void set_kind(const LineLoadOn<G, N>& a, LineLoadOn<G, N, LanePack>& b, int law) {
  b.follows = a.follows;
  b.law = law;
}
template <class G>
void set_kind(const RigidBodyOn<G, double>& a, RigidBodyOn<G, LanePack>& b, int) {
  b.is_point = a.is_point;
}
template <class G>
void set_kind(const PointLoadOn<G, double>& a, PointLoadOn<G, LanePack>& b, int law) {
  b.follows = a.follows;
  b.law = law;
}
template <class G>
void set_kind(const SpringOn<G, double>&, SpringOn<G, LanePack>&, int) {}
template <class G>
void set_kind(const BushingOn<G, double>& a, BushingOn<G, LanePack>& b, int) {
  b.has_damping = a.has_damping;
}
template <class G>
void set_kind(const JointOn<G, double>& a, JointOn<G, LanePack>& b, int law) {
  b.num_rows = a.num_rows;
  b.num_efforts = a.num_efforts;
  for (int k = 0; k < a.num_rows; ++k) {
    b.rows[k].kind = a.rows[k].kind;
    set_axes(a.rows[k], b.rows[k]);
    b.rows[k].law = a.rows[k].law < 0 ? -1 : law++;
  }
  for (int k = 0; k < a.num_efforts; ++k) {
    b.efforts[k].coordinate = a.efforts[k].coordinate;
    set_axes(a.efforts[k].direction, b.efforts[k].direction);
    b.efforts[k].law = a.efforts[k].law < 0 ? -1 : law++;
  }
}

template <class E>
bool may_share_lanes(const E& a, const E& b) {
  for (int k = 0; k < E::num_ports; ++k)
    if ((a.ports[k].node == ground) != (b.ports[k].node == ground) || a.ports[k].has_offset != b.ports[k].has_offset ||
        a.ports[k].carrier != b.ports[k].carrier)
      return false;
  return is_same_kind(a, b);
}

template <class E>
bool has_same_numbers(const E& a, const E& b) {
  if (!may_share_lanes(a, b)) return false;
  bool is_same = true;
  E to = b;
  const auto compare = [&is_same](double x, double y) { is_same = is_same && x == y; };
  for (int k = 0; k < E::num_ports; ++k) visit_pose(a.ports[k].offset, to.ports[k].offset, compare);
  visit_numbers(a, to, compare);
  return is_same;
}

template <class E>
LaneElement<E> make_lane_element(const E* const* elements, int count, const int* nodes, int first_law) {
  LaneElement<E> r;
  set_kind(*elements[0], r, first_law);
  for (int k = 0; k < E::num_ports; ++k) {
    r.ports[k].node = elements[0]->ports[k].node == ground ? ground : nodes[k];
    r.ports[k].has_offset = elements[0]->ports[k].has_offset;
    r.ports[k].carrier = elements[0]->ports[k].carrier;
  }
  for (int lane = 0; lane < num_lanes; ++lane) {
    const E& e = *elements[lane < count ? lane : count - 1];
    const auto set = [lane](double from, LanePack& to) { to.set(lane, from); };
    for (int k = 0; k < E::num_ports; ++k) visit_pose(e.ports[k].offset, r.ports[k].offset, set);
    visit_numbers(e, r, set);
  }
  return r;
}

template <class E>
void evaluate_lanes(const E& e, const FieldOn<typename E::Group, LanePack>& field, const LanePack* multipliers,
                    const LanePack& turns, LanePack* residual, LanePack* magnitude, LanePack* tangent) {
  evaluate_element(e, field, multipliers, turns, residual, tangent);
  if (magnitude != nullptr) eval_magnitude(e, field, residual, magnitude);
}

}  // namespace bough::elements

/// Instantiates the lane form of one element type.
#define BOUGH_INSTANTIATE_LANES(E)                                                                         \
  template bool may_share_lanes(const E&, const E&);                                                       \
  template bool has_same_numbers(const E&, const E&);                                                      \
  template LaneElement<E> make_lane_element(const E* const*, int, const int*, int);                        \
  template void evaluate_lanes(const LaneElement<E>&, const FieldOn<E::Group, LanePack>&, const LanePack*, \
                               const LanePack&, LanePack*, LanePack*, LanePack*);
/// Both forms of an element in a plane, which have their constants alike.
#define BOUGH_INSTANTIATE_PLANAR(E)                                                                            \
  template void evaluate(const E&, const FieldOn<E::Group, double>&, const double*, double, double*, double*); \
  BOUGH_INSTANTIATE_LANES(E)
