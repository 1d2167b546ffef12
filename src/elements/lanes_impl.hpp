#pragma once
/// Bodies of evaluate_lanes.hpp; included in the files that instantiate them.
#include "bough/elements/evaluate_lanes.hpp"
#include "evaluate_impl.hpp"

namespace bough::elements {

/// Each field of an element as visit(field of the first, field of the second): numbers that may differ between lanes.
template <class A, class B, class Visit>
void visit_frame(const Frame<A>& a, Frame<B>& b, const Visit& visit) {
  for (int i = 0; i < 9; ++i) visit(a.R.m[i], b.R.m[i]);
  for (int i = 0; i < 3; ++i) visit(a.x[i], b.x[i]);
}
template <class A, class B, int N, class Visit>
void visit_all(const Vec<A, N>& a, Vec<B, N>& b, const Visit& visit) {
  for (int i = 0; i < N; ++i) visit(a[i], b[i]);
}
template <class A, class B, class Visit>
void visit_all(const Mat6<A>& a, Mat6<B>& b, const Visit& visit) {
  for (int i = 0; i < 36; ++i) visit(a.m[i], b.m[i]);
}
template <int N, class A, class B, class Visit>
void visit_numbers(const Beam<N, A>& a, Beam<N, B>& b, const Visit& visit) {
  visit(a.length, b.length);
  visit_all(a.stiffness, b.stiffness, visit);
  visit_all(a.damping, b.damping, visit);
  visit_all(a.mass, b.mass, visit);
  for (int g = 0; g < N - 1; ++g) visit_all(a.reference_strain[g], b.reference_strain[g], visit);
}
template <int N, class A, class B, class Visit>
void visit_numbers(const LineLoad<N, A>& a, LineLoad<N, B>& b, const Visit& visit) {
  visit(a.length, b.length);
  visit_all(a.wrench, b.wrench, visit);
}
template <class A, class B, class Visit>
void visit_numbers(const RigidBodyOf<A>& a, RigidBodyOf<B>& b, const Visit& visit) {
  visit_all(a.mass, b.mass, visit);
}
template <class A, class B, class Visit>
void visit_numbers(const PointLoadOf<A>& a, PointLoadOf<B>& b, const Visit& visit) {
  visit_all(a.wrench, b.wrench, visit);
}
template <class A, class B, class Visit>
void visit_numbers(const SpringOf<A>& a, SpringOf<B>& b, const Visit& visit) {
  visit(a.stiffness, b.stiffness);
  visit(a.rest_length, b.rest_length);
  visit(a.damping, b.damping);
}
template <class A, class B, class Visit>
void visit_numbers(const BushingOf<A>& a, BushingOf<B>& b, const Visit& visit) {
  visit_all(a.stiffness, b.stiffness, visit);
  visit_all(a.damping, b.damping, visit);
  visit_all(a.rest, b.rest, visit);
}
template <class A, class B, class Visit>
void visit_numbers(const JointOf<A>& a, JointOf<B>& b, const Visit& visit) {
  for (int k = 0; k < a.num_rows; ++k) visit(a.rows[k].pitch, b.rows[k].pitch);
  for (int k = 0; k < a.num_efforts; ++k) {
    visit(a.efforts[k].stiffness, b.efforts[k].stiffness);
    visit(a.efforts[k].rest, b.efforts[k].rest);
    visit(a.efforts[k].damping, b.efforts[k].damping);
  }
}

/// Terms that an element has: the same for all lanes.
template <int N>
bool is_same_kind(const Beam<N>& a, const Beam<N>& b) {
  return a.has_damping == b.has_damping && a.has_mass == b.has_mass;
}
template <int N>
bool is_same_kind(const LineLoad<N>& a, const LineLoad<N>& b) {
  return a.follows == b.follows;
}
inline bool is_same_kind(const RigidBody& a, const RigidBody& b) { return a.is_point == b.is_point; }
inline bool is_same_kind(const PointLoad& a, const PointLoad& b) { return a.follows == b.follows; }
inline bool is_same_kind(const Spring&, const Spring&) { return true; }
inline bool is_same_kind(const Bushing& a, const Bushing& b) { return a.has_damping == b.has_damping; }
inline bool is_same_kind(const Joint& a, const Joint& b) {
  if (a.num_rows != b.num_rows || a.num_efforts != b.num_efforts) return false;
  for (int k = 0; k < a.num_rows; ++k) {
    const ConstraintRow &p = a.rows[k], &q = b.rows[k];
    if (p.kind != q.kind || p.i != q.i || p.j != q.j || (p.law < 0) != (q.law < 0)) return false;
  }
  for (int k = 0; k < a.num_efforts; ++k) {
    const Effort &p = a.efforts[k], &q = b.efforts[k];
    if (p.coordinate != q.coordinate || (p.law < 0) != (q.law < 0)) return false;
  }
  return true;
}

/// Copies the kind and renumbers the laws from `law` on.
template <int N>
void set_kind(const Beam<N>& a, Beam<N, LanePack>& b, int) {
  b.has_damping = a.has_damping;
  b.has_mass = a.has_mass;
}
template <int N>
void set_kind(const LineLoad<N>& a, LineLoad<N, LanePack>& b, int law) {
  b.follows = a.follows;
  b.law = law;
}
inline void set_kind(const RigidBody& a, RigidBodyOf<LanePack>& b, int) { b.is_point = a.is_point; }
inline void set_kind(const PointLoad& a, PointLoadOf<LanePack>& b, int law) {
  b.follows = a.follows;
  b.law = law;
}
inline void set_kind(const Spring&, SpringOf<LanePack>&, int) {}
inline void set_kind(const Bushing& a, BushingOf<LanePack>& b, int) { b.has_damping = a.has_damping; }
inline void set_kind(const Joint& a, JointOf<LanePack>& b, int law) {
  b.num_rows = a.num_rows;
  b.num_efforts = a.num_efforts;
  for (int k = 0; k < a.num_rows; ++k) {
    b.rows[k].kind = a.rows[k].kind;
    b.rows[k].i = a.rows[k].i;
    b.rows[k].j = a.rows[k].j;
    b.rows[k].law = a.rows[k].law < 0 ? -1 : law++;
  }
  for (int k = 0; k < a.num_efforts; ++k) {
    b.efforts[k].coordinate = a.efforts[k].coordinate;
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
  for (int k = 0; k < E::num_ports; ++k) visit_frame(a.ports[k].offset, to.ports[k].offset, compare);
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
    for (int k = 0; k < E::num_ports; ++k) visit_frame(e.ports[k].offset, r.ports[k].offset, set);
    visit_numbers(e, r, set);
  }
  return r;
}

template <class E>
void evaluate_lanes(const E& e, const FieldLanes& field, const LanePack* multipliers, const LanePack& turns,
                    LanePack* residual, LanePack* magnitude, LanePack* tangent) {
  evaluate_element<E, LanePack>(e, field, multipliers, turns, residual, tangent);
  if (magnitude != nullptr) eval_magnitude<E, LanePack>(e, field, residual, magnitude);
}

}  // namespace bough::elements

/// Instantiates the lane form of one element type.
#define BOUGH_INSTANTIATE_LANES(E)                                                                                    \
  template bool may_share_lanes(const E&, const E&);                                                                  \
  template bool has_same_numbers(const E&, const E&);                                                                 \
  template LaneElement<E> make_lane_element(const E* const*, int, const int*, int);                                   \
  template void evaluate_lanes(const LaneElement<E>&, const FieldLanes&, const LanePack*, const LanePack&, LanePack*, \
                               LanePack*, LanePack*);
