#pragma once
/// Operations on the data of any element, once the element has declared them. An element declares its data by
///   template <class A, class B, class Visit> static void visit_data(A& a, B& b, Visit& visit)
/// which passes each datum of a, together with that of b, to the visitor's function for its kind. a and b are the same
/// element, with constants of the same or of another type (double or packs), on the same or on another group:
///   number(x, y)         a scalar
///   matrix(x, y)         of a section or a body, in the axes of the first port
///   vector(x, y)         a strain or a twist, in the axes of the first port
///   unit(x, y)           a unit vector of displacements, in the axes of the first port
///   axis(x, y)           a unit vector of rotations, in the same axes
///   wrench(x, y, follows)  in the axes of the first port, or, of dead loads, in inertial axes
///   direction(x, y)      of a row or an effort of a joint
///  flag(x, y)           a value on which a kernel branches: equal in all lanes
///  law(x, y)            the index of a time function, -1: none; whether it is -1 counts as a flag
/// Ports are common to all elements and are not visited; `data_axes` says in which axes the data are given.
#include <type_traits>

#include "bough/elements/port.hpp"

namespace bough::elements {

/// A visitor of numbers: every number of a datum is passed to `each`, whatever the kind of the datum.
template <class Each>
class NumbersOf {
 public:
  explicit NumbersOf(Each& each) : each_(each) {}
  template <class X, class Y>
  void number(const X& x, Y& y) const {
    each_(x, y);
  }
  template <class X, class Y>
  void vector(const X& x, Y& y) const {
    for (int i = 0; i < X::size(); ++i) each_(x[i], y[i]);
  }
  template <class X, class Y>
  void unit(const X& x, Y& y) const {
    vector(x, y);
  }
  template <class X, class Y>
  void axis(const X& x, Y& y) const {
    vector(x, y);
  }
  template <class X, class Y>
  void matrix(const X& x, Y& y) const {
    for (int i = 0; i < X::rows() * X::cols(); ++i) each_(x.m[i], y.m[i]);
  }
  /// A matrix in space, a complex number in a plane; without numbers where nothing turns.
  template <class X, class Y>
  void rotation(const X& x, Y& y) const {
    if constexpr (requires { x.m; })
      matrix(x, y);
    else if constexpr (!std::is_empty_v<X>)
      vector(x, y);
  }
  template <class X, class Y>
  void wrench(const X& x, Y& y, bool) const {
    vector(x, y);
  }
  template <class X, class Y>
  void direction(const X& x, Y& y) const {
    if constexpr (X::has_numbers) vector(x.d, y.d);
  }
  template <class X, class Y>
  void flag(const X&, const Y&) const {}
  template <class X, class Y>
  void law(const X&, const Y&) const {}

 private:
  Each& each_;
};

/// A visitor of branch conditions: flags are passed to kind.flag, laws to kind.law.
template <class Kind>
class KindOf {
 public:
  explicit KindOf(Kind& kind) : kind_(kind) {}
  template <class X, class Y>
  void number(const X&, const Y&) const {}
  template <class X, class Y>
  void vector(const X&, const Y&) const {}
  template <class X, class Y>
  void unit(const X&, const Y&) const {}
  template <class X, class Y>
  void axis(const X&, const Y&) const {}
  template <class X, class Y>
  void matrix(const X&, const Y&) const {}
  template <class X, class Y>
  void wrench(const X&, const Y&, bool) const {}
  template <class X, class Y>
  void direction(const X& x, Y& y) const {
    if constexpr (!X::has_numbers) {
      kind_.flag(x.i, y.i);
      kind_.flag(x.j, y.j);
    }
  }
  template <class X, class Y>
  void flag(const X& x, Y& y) const {
    kind_.flag(x, y);
  }
  template <class X, class Y>
  void law(const X& x, Y& y) const {
    kind_.law(x, y);
  }

 private:
  Kind& kind_;
};

/// Lists the laws of an element, in the order in which the element declares them.
struct LawLister {
  int* laws;
  int count = 0;
  template <class X>
  void flag(const X&, const X&) const {}
  void law(int law, int) {
    if (law >= 0) laws[count++] = law;
  }
};

}  // namespace bough::elements
