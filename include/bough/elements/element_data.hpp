#pragma once
/// What can be done with the data of any element once it has declared them. An element declares its data by
///   template <class A, class B, class Visit> static void visit_data(A& a, B& b, Visit& visit)
/// which hands each datum of a, with that of b, to the function of its kind. a and b are the element itself, in the
/// same or in other numbers (double or packs), on the same or on another group:
///   number(x, y)         a scalar
///   matrix(x, y)         of a section or a body, in the axes of the first port
///   vector(x, y)         a strain or a twist, in the axes of the first port
///   wrench(x, y, follows)  in the axes of the first port, or, of dead loads, in inertial axes
///   direction(x, y)      of a row or an effort of a joint
///   flag(x, y)           what a kernel branches on: the same in all lanes
///   law(x, y)            the index of a time function, -1: none; whether there is one is a flag
/// Ports are common to all elements and not handed over; `data_axes` tells in which axes the data are.
#include "bough/elements/port.hpp"

namespace bough::elements {

/// A visitor of numbers alone: every number of a datum is handed to `each`, whatever its kind.
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
  void matrix(const X& x, Y& y) const {
    for (int i = 0; i < X::rows() * X::cols(); ++i) each_(x.m[i], y.m[i]);
  }
  /// A matrix in space, a complex number in a plane.
  template <class X, class Y>
  void rotation(const X& x, Y& y) const {
    if constexpr (requires { x.m; })
      matrix(x, y);
    else
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

/// A visitor of what a kernel branches on: flags are handed to kind.flag, laws to kind.law.
template <class Kind>
class KindOf {
 public:
  explicit KindOf(Kind& kind) : kind_(kind) {}
  template <class X, class Y>
  void number(const X&, const Y&) const {}
  template <class X, class Y>
  void vector(const X&, const Y&) const {}
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

/// The laws that an element has, in the order in which it declares them.
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
