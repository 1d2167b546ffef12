#pragma once
/// Bodies of planar/evaluate.hpp for lanes; included in the files that instantiate them.
#include "evaluate_impl.hpp"

namespace bough::elements::planar {

/// Numbers that may differ between lanes, as visit(number of the first, number of the second).
template <class A, class B, int N, class Visit>
void visit_all(const lanes::Vec<A, N>& a, lanes::Vec<B, N>& b, const Visit& visit) {
  for (int i = 0; i < N; ++i) visit(a[i], b[i]);
}
template <class A, class B, class Visit>
void visit_all(const Mat3<A>& a, Mat3<B>& b, const Visit& visit) {
  for (int i = 0; i < 9; ++i) visit(a.m[i], b.m[i]);
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
  for (int k = 0; k < a.num_rows; ++k) visit_all(a.rows[k].d, b.rows[k].d, visit);
  for (int k = 0; k < a.num_efforts; ++k) {
    visit_all(a.efforts[k].d, b.efforts[k].d, visit);
    visit(a.efforts[k].effort.stiffness, b.efforts[k].effort.stiffness);
    visit(a.efforts[k].effort.rest, b.efforts[k].effort.rest);
    visit(a.efforts[k].effort.damping, b.efforts[k].effort.damping);
  }
}

/// Terms that an element has, the same for all lanes: whether two agree, and a copy with the laws renumbered from `law` on.
template <class E>
bool is_same_kind(const E& a, const E& b) {
  if constexpr (requires { a.is_point; })
    return a.is_point == b.is_point;
  else if constexpr (requires { a.has_mass; })
    return a.has_damping == b.has_damping && a.has_mass == b.has_mass;
  else if constexpr (requires { a.has_damping; })
    return a.has_damping == b.has_damping;
  else if constexpr (requires { a.follows; })
    return a.follows == b.follows;
  else if constexpr (E::num_rows_at_most > 0) {
    if (a.num_rows != b.num_rows || a.num_efforts != b.num_efforts) return false;
    for (int k = 0; k < a.num_rows; ++k)
      if (a.rows[k].kind != b.rows[k].kind || (a.rows[k].law < 0) != (b.rows[k].law < 0)) return false;
    for (int k = 0; k < a.num_efforts; ++k)
      if (a.efforts[k].coordinate != b.efforts[k].coordinate ||
          (a.efforts[k].effort.law < 0) != (b.efforts[k].effort.law < 0))
        return false;
    return true;
  } else
    return true;
}
template <class A, class B>
void set_kind(const A& a, B& b, int law) {
  if constexpr (requires { a.is_point; }) b.is_point = a.is_point;
  if constexpr (requires { a.has_mass; }) b.has_mass = a.has_mass;
  if constexpr (requires { a.has_damping; }) b.has_damping = a.has_damping;
  if constexpr (requires { a.follows; }) {
    b.follows = a.follows;
    b.law = law;
  }
  if constexpr (A::num_rows_at_most > 0) {
    b.num_rows = a.num_rows;
    b.num_efforts = a.num_efforts;
    for (int k = 0; k < a.num_rows; ++k) {
      b.rows[k].kind = a.rows[k].kind;
      b.rows[k].law = a.rows[k].law < 0 ? -1 : law++;
    }
    for (int k = 0; k < a.num_efforts; ++k) {
      b.efforts[k].coordinate = a.efforts[k].coordinate;
      b.efforts[k].effort.coordinate = a.efforts[k].coordinate;
      b.efforts[k].effort.law = a.efforts[k].effort.law < 0 ? -1 : law++;
    }
  }
}

template <class E>
bool may_share_lanes(const E& a, const E& b) {
  for (int k = 0; k < E::num_ports; ++k)
    if ((a.ports[k].node == ground) != (b.ports[k].node == ground) || a.ports[k].has_offset != b.ports[k].has_offset)
      return false;
  return is_same_kind(a, b);
}

template <class E>
bool has_same_numbers(const E& a, const E& b) {
  if (!may_share_lanes(a, b)) return false;
  bool is_same = true;
  E to = b;
  const auto compare = [&is_same](double x, double y) { is_same = is_same && x == y; };
  for (int k = 0; k < E::num_ports; ++k) {
    visit_all(a.ports[k].turn, to.ports[k].turn, compare);
    visit_all(a.ports[k].x, to.ports[k].x, compare);
  }
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
  }
  for (int lane = 0; lane < num_lanes; ++lane) {
    const E& e = *elements[lane < count ? lane : count - 1];
    const auto set = [lane](double from, LanePack& to) { to.set(lane, from); };
    for (int k = 0; k < E::num_ports; ++k) {
      visit_all(e.ports[k].turn, r.ports[k].turn, set);
      visit_all(e.ports[k].x, r.ports[k].x, set);
    }
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

}  // namespace bough::elements::planar

/// Instantiates all forms of one element type.
#define BOUGH_INSTANTIATE_PLANAR(E)                                                                                   \
  template void evaluate(const E&, const Field&, const double*, double, double*, double*, double*);                   \
  template bool may_share_lanes(const E&, const E&);                                                                  \
  template bool has_same_numbers(const E&, const E&);                                                                 \
  template LaneElement<E> make_lane_element(const E* const*, int, const int*, int);                                   \
  template void evaluate_lanes(const LaneElement<E>&, const FieldLanes&, const LanePack*, const LanePack&, LanePack*, \
                               LanePack*, LanePack*);
