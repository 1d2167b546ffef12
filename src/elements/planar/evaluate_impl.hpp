#pragma once
/// Bodies of planar/evaluate.hpp; included in the files that instantiate them.
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements::planar {

using lanes::Jet;

template <class E, class S, class T>
void eval_kernel(const E& e, const PortMotion<T>* p, const S* multipliers, const S& turns,
                 const Surroundings<T>& around, Vec3<T>* out, T* rows) {
  if constexpr (E::num_rows_at_most > 0)
    eval_joint(e, p, multipliers, around, turns, out, rows);
  else
    eval_residual(e, p, around, out);
}

template <class E, class S>
const PairOf<S>* anchor_of(const E& e, const NodeOf<S>* nodes) {
  for (const auto& port : e.ports)
    if (port.node != ground) return &nodes[port.node].x;
  return nullptr;
}
template <class S>
Vec2<S> difference(const PairOf<S>& a, const PairOf<S>& b) {
  Vec2<S> r;
  for (int i = 0; i < 2; ++i) {
    S s, e;
    motion::two_sum(a.hi[i], S(-b.hi[i]), s, e);
    r[i] = s + (e + (a.lo[i] - b.lo[i]));
  }
  return r;
}

/// Pose, twist and acceleration at a port from those of its node (in scalar T, jets or not).
template <class C, class T>
void apply_offset(const PortOf<C>& port, PortMotion<T>& p) {
  if (!port.has_offset) return;
  p.x += motion::complex_times(port.x, p.turn);
  p.turn = motion::complex_times(port.turn, p.turn);
  p.v = seen_from(port.turn, port.x, p.v);
  p.a = seen_from(port.turn, port.x, p.a);
}

template <class E, class S>
PortMotion<S> node_motion(const E& e, int k, const FieldOf<S>& field, const PairOf<S>& anchor) {
  const PortOf<S>& port = e.ports[k];
  if (port.node == ground)
    return {port.turn, difference({port.x, Vec2<S>::zero()}, anchor), Vec3<S>::zero(), Vec3<S>::zero()};
  const NodeOf<S>& n = field.nodes[port.node];
  return {n.turn, difference(n.x, anchor), n.v, n.a};
}

/// The node's motion with its derivatives by its own increment, which are directions `first` to `first + 2`:
///   d turn = i turn eta_w,  dx = turn eta_u,  dv = velocity T(dq)^-1 eta,  da = acceleration T(dq)^-1 eta
template <int D, class S>
PortMotion<Jet<S, D>> seeded(const PortMotion<S>& p, const NodeOf<S>& node, const Slopes& slopes, bool moves,
                             bool has_rates, int first) {
  using T = Jet<S, D>;
  PortMotion<T> r;
  for (int i = 0; i < 2; ++i) {
    r.turn[i] = T(p.turn[i]);
    r.x[i] = T(p.x[i]);
  }
  for (int i = 0; i < 3; ++i) {
    r.v[i] = T(p.v[i]);
    r.a[i] = T(p.a[i]);
  }
  if (moves) {
    r.turn[0].d[first + 2] = -p.turn[1];
    r.turn[1].d[first + 2] = p.turn[0];
    r.x[0].d[first] = p.turn[0];
    r.x[0].d[first + 1] = -p.turn[1];
    r.x[1].d[first] = p.turn[1];
    r.x[1].d[first + 1] = p.turn[0];
  }
  if (!has_rates) return r;
  if (slopes.mass_only) {
    for (int i = 0; i < 3; ++i) r.a[i].d[first + i] = S(1.0);
    return r;
  }
  const Mat3<S> inverse = motion::inverse_tangent_plane(node.dq);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r.v[i].d[first + j] = slopes.velocity * inverse(i, j);
      r.a[i].d[first + j] = slopes.acceleration * inverse(i, j);
    }
  return r;
}

/// Whether an element's forces depend on velocities or accelerations.
template <class E>
bool looks_at_rates(const E& e) {
  if constexpr (requires { e.has_mass; })
    return e.has_mass || e.has_damping;
  else if constexpr (requires { e.has_damping; })
    return e.has_damping;
  else if constexpr (requires { e.rest_length; })
    return is_present(e.damping);
  else if constexpr (requires { e.mass; })
    return true;
  else if constexpr (E::num_rows_at_most > 0) {
    bool damped = false;
    for (int k = 0; k < e.num_efforts; ++k) damped = damped || is_present(e.efforts[k].effort.damping);
    return damped;
  } else
    return false;  // loads
}

/// Wrenches at the nodes, ports on the ground left out, then rows.
template <class E, class T>
void gather(const E& e, const Vec3<T>* out, const T* rows, T* residual) {
  int n = 0;
  for (int k = 0; k < E::num_ports; ++k) {
    if (e.ports[k].node == ground) continue;
    const Vec3<T> f = e.ports[k].has_offset ? carried_back(e.ports[k].turn, e.ports[k].x, out[k]) : out[k];
    for (int i = 0; i < 3; ++i) residual[n++] = f[i];
  }
  for (int k = 0; k < num_multipliers(e); ++k) residual[n++] = rows[k];
}

template <class E, class S>
void eval_magnitude(const E& e, const FieldOf<S>& field, const S* residual, S* magnitude) {
  using std::abs;
  for (int i = 0; i < num_unknowns(e); ++i) magnitude[i] = abs(residual[i]);
  if constexpr (std::is_same_v<E, RigidBodyOf<S>>) {
    const NodeOf<S>& n = field.nodes[e.ports[0].node];
    const Vec2<S> weight = motion::conjugate_times(n.turn, field.around.gravity);
    if (e.is_point) {
      Vec2<S> terms[3] = {e.mass(0, 0) * weight, Vec2<S>::zero(), Vec2<S>::zero()};
      if (field.around.has_inertia) {
        terms[1] = e.mass(0, 0) * motion::plane_part(n.a);
        terms[2] = n.v[2] * motion::quarter_turn(Vec2<S>(e.mass(0, 0) * motion::plane_part(n.v)));
      }
      for (int i = 0; i < 2; ++i)
        for (const Vec2<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
      return;
    }
    Vec3<S> terms[3] = {e.mass * motion::join(weight, S(0.0)), Vec3<S>::zero(), Vec3<S>::zero()};
    if (field.around.has_inertia) {
      terms[1] = e.mass * n.a;
      terms[2] = gyroscopic(n.v, Vec3<S>(e.mass * n.v));
    }
    for (int i = 0; i < 3; ++i)
      for (const Vec3<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
  }
}

template <class E, class S>
void evaluate_element(const E& e, const FieldOf<S>& field, const S* multipliers, const S& turns, S* residual,
                      S* tangent) {
  constexpr int P = E::num_ports, D = 3 * P, most_rows = E::num_rows_at_most;
  PortMotion<S> nodes[P], p[P];
  const PairOf<S> anchor = *anchor_of(e, field.nodes);
  for (int k = 0; k < P; ++k) {
    p[k] = nodes[k] = node_motion(e, k, field, anchor);
    if (e.ports[k].node != ground) apply_offset(e.ports[k], p[k]);
  }
  Vec3<S> out[P];
  S rows[most_rows + 1];
  eval_kernel<E, S, S>(e, p, multipliers, turns, field.around, out, rows);
  gather<E, S>(e, out, rows, residual);
  if (tangent == nullptr) return;

  using T = Jet<S, D>;
  const bool mass_only = field.slopes.mass_only, is_joint = most_rows > 0;
  const bool has_rates = field.around.has_inertia && looks_at_rates(e);
  PortMotion<T> moved[P];
  for (int k = 0; k < P; ++k) {
    const bool on_ground = e.ports[k].node == ground;
    moved[k] = seeded<D>(nodes[k], field.nodes[on_ground ? 0 : e.ports[k].node], field.slopes,
                         !on_ground && (!mass_only || is_joint), !on_ground && has_rates, 3 * k);
    if (!on_ground) apply_offset(e.ports[k], moved[k]);
  }
  const Surroundings<T> around{
      {{T(field.around.gravity[0]), T(field.around.gravity[1])}}, field.around.laws, field.around.has_inertia};
  Vec3<T> slopes[P];
  T row_slopes[most_rows + 1], all[D + most_rows + 1];
  eval_kernel<E, S, T>(e, moved, multipliers, turns, around, slopes, row_slopes);
  gather<E, T>(e, slopes, row_slopes, all);
  const int n = num_unknowns(e), m = num_multipliers(e), forces = n - m;
  int column = 0;
  for (int k = 0; k < P; ++k) {
    if (e.ports[k].node == ground) continue;
    for (int j = 0; j < 3; ++j, ++column) {
      for (int i = 0; i < forces; ++i) tangent[i * n + column] = is_joint && mass_only ? S(0.0) : all[i].d[3 * k + j];
      for (int i = forces; i < n; ++i)  // forces are G^T lambda: the columns of the multipliers
        tangent[i * n + column] = tangent[column * n + i] = all[i].d[3 * k + j];
    }
  }
  for (int i = forces; i < n; ++i)
    for (int j = forces; j < n; ++j) tangent[i * n + j] = S(0.0);
}

template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* magnitude, double* tangent) {
  evaluate_element<E, double>(e, field, multipliers, turns, residual, tangent);
  eval_magnitude<E, double>(e, field, residual, magnitude);
}

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
