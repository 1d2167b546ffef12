#pragma once
/// Couplings that are declared whole in one header, from their keys in a scene to their forces. Such an element is a
/// template over the group and the type of its constants that derives from CouplingOn, and has
///   members              for its numbers (C), directions (G::Translation<C>) and axes (AxisOn<G, C>), both in the axes
///                        of the first port, matrices (G::Matrix<C>) in the same axes, and laws (int, -1: none)
///   declared()           names them once: a tuple of number(...), strength(...), distance(...), direction(...),
///                        axis(...), matrix(...) and law(...)
///   words                the list of a scene, the name and what it does
///   eval_residual        wrenches that resist motions of its ports, in their axes (as of every element)
///   eval_strain_energy   whose derivative the residual is without dampers
///   looks_at_rates       whether forces depend on velocities
/// and a line in catalogue.hpp. Its tangent is the residual's own source run on jets, or one of its own: eval_tangent,
/// where has_closed_tangent. Readers, schema, checks, plan, reduced models, lanes, energies, balances, sensors and
/// pictures follow from these.
#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

#include "bough/elements/port.hpp"
#include "bough/scene/coupling_kind.hpp"

namespace bough::elements {

/// A declared datum: what scenes know of it, and the member that holds it.
template <scene::CouplingFieldType field_type, class Member>
struct Declared {
  static constexpr scene::CouplingFieldType type = field_type;
  scene::CouplingField field;
  Member member;
};

template <scene::CouplingFieldType type, class E, class M>
constexpr auto declare(M E::*member, scene::CouplingField field) {
  field.type = type;
  return Declared<type, M E::*>{field, member};
}

/// standard: JSON text of the value where a scene gives none; empty: it has to be given.
template <class E, class C>
constexpr auto number(const char* name, C E::*member, const char* unit, double low, bool is_low_open,
                      const char* standard, const char* about) {
  return declare<scene::CouplingFieldType::number>(member, {name, {}, unit, about, low, is_low_open, standard});
}
/// A number of at least 0, and 0 where none is given: without any of its strengths a coupling does nothing.
template <class E, class C>
constexpr auto strength(const char* name, C E::*member, const char* unit, const char* about) {
  return declare<scene::CouplingFieldType::number>(
      member, {.name = name, .unit = unit, .about = about, .standard = "0", .is_strength = true});
}
/// A length of at least 0: where none is given the distance of the two ends at the start.
template <class E, class C>
constexpr auto distance(const char* name, C E::*member, const char* about) {
  return declare<scene::CouplingFieldType::number>(
      member, {.name = name, .unit = "m", .about = about, .starts_as_distance = true});
}
template <class E, class D>
constexpr auto direction(const char* name, D E::*member, const char* standard, const char* about) {
  return declare<scene::CouplingFieldType::direction>(
      member, {.name = name, .unit = "-", .about = about, .standard = standard});
}
/// A strength: symmetric, positive semidefinite, of all relative motions of two frames.
template <class E, class M>
constexpr auto matrix(const char* name, M E::*member, const char* unit, const char* about) {
  return declare<scene::CouplingFieldType::matrix>(member,
                                                   {.name = name, .unit = unit, .about = about, .is_strength = true});
}
/// A factor of the matrix of the key `multiplied`.
template <class E>
constexpr auto law(const char* name, int E::*member, const char* multiplied, const char* about) {
  return declare<scene::CouplingFieldType::law>(member,
                                                {.name = name, .unit = "-", .about = about, .multiplied = multiplied});
}

/// An axis of rotations in the axes of a frame. In a plane, whose normal it is, its sign is left.
template <class G, class C>
using AxisOn = std::conditional_t<G::dof == 6, Vec<C, 3>, Vec<C, 1>>;
template <class E, class A>
constexpr auto axis(const char* name, A E::*member, const char* standard, const char* about) {
  return declare<scene::CouplingFieldType::axis>(member,
                                                 {.name = name, .unit = "-", .about = about, .standard = standard});
}
/// The angle of a relative motion d about an axis: a component of its rotation vector.
template <class S, class C>
BOUGH_INLINE S angle_about(const Vec<C, 3>& axis, const Vec6<S>& d) {
  return axis[0] * d[3] + axis[1] * d[4] + axis[2] * d[5];
}
template <class S, class C>
BOUGH_INLINE S angle_about(const Vec<C, 1>& axis, const Vec3<S>& d) {
  return axis[0] * d[2];
}
/// A moment about an axis, as a vector of the group.
template <class G, class S, class C>
BOUGH_INLINE typename G::template Vector<S> moment_about(const AxisOn<G, C>& axis, const S& moment) {
  auto f = G::template Vector<S>::zero();
  constexpr int first = G::dof - AxisOn<G, C>::size();
  for (int i = 0; i < AxisOn<G, C>::size(); ++i) f[first + i] = axis[i] * moment;
  return f;
}

/// The residual of a force f on the second port, at its origin, and of its reaction on the first, which has the same
/// line of action; r: from the first origin to the second. f and r are in inertial axes.
template <class G, class S>
BOUGH_INLINE void put_point_force(const PortMotionOn<G, S>* p, const typename G::template Translation<S>& r,
                                  const typename G::template Translation<S>& f, S* out) {
  using Vector = typename G::template Vector<S>;
  typename G::template Pose<S> second = G::template Pose<S>::identity();  // seen from the first
  second.x = G::turned_back(p[0].H, r);
  const Vector reaction =
      G::inverse_adjoint_transpose_times(second, Vector(G::vector_of_wrench(G::force(G::turned_back(p[0].H, f)))));
  for (int i = 0; i < G::dof; ++i) out[i] = reaction[i];
  G::put_force(G::turned_back(p[1].H, typename G::template Translation<S>(-f)), out + G::dof);
}

/// Passes declared data of a and b, which are one element on groups and of constants of their own, to a visitor
/// (element_data.hpp).
template <class A, class B, class Visit>
void visit_declared(A& a, B& b, Visit& visit) {
  constexpr auto from = std::remove_const_t<A>::declared();
  constexpr auto to = std::remove_const_t<B>::declared();
  const auto one = [&](const auto& x, const auto& y) {
    constexpr scene::CouplingFieldType type = std::decay_t<decltype(x)>::type;
    if constexpr (type == scene::CouplingFieldType::number)
      visit.number(a.*x.member, b.*y.member);
    else if constexpr (type == scene::CouplingFieldType::direction)
      visit.unit(a.*x.member, b.*y.member);
    else if constexpr (type == scene::CouplingFieldType::axis)
      visit.axis(a.*x.member, b.*y.member);
    else if constexpr (type == scene::CouplingFieldType::matrix)
      visit.matrix(a.*x.member, b.*y.member);
    else
      visit.law(a.*x.member, b.*y.member);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (one(std::get<I>(from), std::get<I>(to)), ...); }
  (std::make_index_sequence<std::tuple_size_v<decltype(from)>>{});
}

/// What all couplings of the catalogue have in common.
template <class G, class C>
struct CouplingOn {
  using Group = G;
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[2];

  static constexpr Role role = Role::coupling;
  static constexpr Cost cost = small_cost;
  /// Whether it resists log(H_a^-1 H_b) by a matrix `stiffness`, as its tangent and its elastic inertia.
  static constexpr bool has_stiffness_matrix = false;
  static constexpr DataAxes data_axes = DataAxes::port;
  /// Whether it acts on its second end by forces at the origin of that port alone.
  static constexpr bool pulls_at_point = false;
  /// Whether its only force is the tension k (l - l0) + c l' along the line between its ports: its members stiffness,
  /// rest_length and damping, which are declared first and in this order.
  static constexpr bool acts_along_line = false;
  static constexpr scene::CouplingStart start = scene::CouplingStart::apart;
  /// Whether it brings a tangent of its own: a function eval_tangent beside eval_residual.
  static constexpr bool has_closed_tangent = false;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit_declared(a, b, visit);
  }
};

/// The names of a kind in a scene.
struct CouplingWords {
  const char *list, *name, *about, *first, *second;
};

template <class E>
concept IsCatalogued = requires {
  E::declared();
  E::words;
};

/// Sets the data of a coupling to what a scene gives. first: axes of its first port at the start; laws: the indices of
/// its laws, -1 for those that are not given; null: none is.
template <IsCatalogued E>
void take_data(E& e, const double* value, const Mat3<double>& first, const int* laws = nullptr) {
  constexpr auto declared = E::declared();
  const auto one = [&](const auto& datum) {
    constexpr scene::CouplingFieldType type = std::decay_t<decltype(datum)>::type;
    auto& to = e.*datum.member;
    if constexpr (type == scene::CouplingFieldType::number) {
      to = *value;
    } else if constexpr (type == scene::CouplingFieldType::matrix) {
      std::copy_n(value, datum.field.count(), to.m);
    } else if constexpr (type == scene::CouplingFieldType::law) {
      to = laws == nullptr ? -1 : *laws++;
    } else {
      const Vec3<double> d{{value[0], value[1], value[2]}};
      to = lanes::transpose_times(first, Vec3<double>((1.0 / lanes::length_of(d)) * d));
    }
    value += datum.field.count();
  };
  std::apply([&](const auto&... data) { (one(data), ...); }, declared);
}

/// Sets what follows from the data and from the pose of the second port as seen from the first at the start. Couplings
/// that keep such things have an overload.
template <class E>
void take_start(E&, const Frame<double>&) {}

/// Stiffness of an element of this type at the start; see scene::CouplingKind.
template <IsCatalogued E>
Mat6<double> eval_stiffness_at_start(const scene::Coupling& given, const Frame<double>& first,
                                     const Frame<double>& second);

namespace detail {
template <class E>
constexpr auto fields_of() {
  return std::apply(
      [](const auto&... data) { return std::array<scene::CouplingField, sizeof...(data)>{data.field...}; },
      E::declared());
}
template <class E>
inline constexpr auto fields = fields_of<E>();
}  // namespace detail

/// The kind of the couplings whose element in space is E.
template <IsCatalogued E>
inline constexpr scene::CouplingKind kind_of{
    E::words.list,     E::words.name,     E::words.about,     E::words.first, E::words.second,
    detail::fields<E>, E::pulls_at_point, E::acts_along_line, E::start,       &eval_stiffness_at_start<E>};

}  // namespace bough::elements
