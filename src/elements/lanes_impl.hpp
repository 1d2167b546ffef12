#pragma once
/// Bodies of evaluate_lanes.hpp; included in the files that emit them.
#include "bough/elements/evaluate_lanes.hpp"
#include "evaluate_impl.hpp"

namespace bough::elements {

/// Compares flags, which all lanes must have in common; whether a law is present counts as one.
class SameKind {
 public:
  template <class X>
  void flag(const X& x, const X& y) {
    same_ = same_ && x == y;
  }
  void law(int x, int y) { flag(x < 0, y < 0); }
  bool same() const { return same_; }

 private:
  bool same_ = true;
};
/// Copies the flags of the first element, and numbers its laws from `law` on.
class SetKind {
 public:
  explicit SetKind(int law) : law_(law) {}
  template <class X>
  void flag(const X& x, X& y) const {
    y = x;
  }
  void law(int x, int& y) { y = x < 0 ? -1 : law_++; }

 private:
  int law_;
};

/// Numbers of the ports.
template <class A, class B, class Visit>
void visit_ports(const A& a, B& b, const Visit& visit) {
  for (int k = 0; k < A::num_ports; ++k) {
    visit.rotation(a.ports[k].offset.R, b.ports[k].offset.R);
    visit.vector(a.ports[k].offset.x, b.ports[k].offset.x);
  }
}

template <class E>
bool may_share_lanes(const E& a, const E& b) {
  for (int k = 0; k < E::num_ports; ++k)
    if ((a.ports[k].node == ground) != (b.ports[k].node == ground) || a.ports[k].has_offset != b.ports[k].has_offset ||
        a.ports[k].carrier != b.ports[k].carrier)
      return false;
  SameKind kind;
  const KindOf visit(kind);
  E::visit_data(a, b, visit);
  return kind.same();
}

template <class E>
bool has_same_numbers(const E& a, const E& b) {
  if (!may_share_lanes(a, b)) return false;
  bool is_same = true;
  const auto compare = [&is_same](double x, double y) { is_same = is_same && x == y; };
  const NumbersOf visit(compare);
  visit_ports(a, b, visit);
  E::visit_data(a, b, visit);
  return is_same;
}

template <class E>
LaneElement<E> make_lane_element(const E* const* elements, int count, const int* nodes, int first_law) {
  LaneElement<E> r;
  SetKind kind(first_law);
  const KindOf set_kind(kind);
  E::visit_data(*elements[0], r, set_kind);
  for (int k = 0; k < E::num_ports; ++k) {
    r.ports[k].node = elements[0]->ports[k].node == ground ? ground : nodes[k];
    r.ports[k].has_offset = elements[0]->ports[k].has_offset;
    r.ports[k].carrier = elements[0]->ports[k].carrier;
  }
  for (int lane = 0; lane < num_lanes; ++lane) {
    const E& e = *elements[lane < count ? lane : count - 1];
    const auto set = [lane](double from, LanePack& to) { to.set(lane, from); };
    const NumbersOf set_numbers(set);
    visit_ports(e, r, set_numbers);
    E::visit_data(e, r, set_numbers);
  }
  return r;
}

template <class E>
void evaluate_lanes(const E& e, const FieldOn<typename E::Group, LanePack>& field, const LanePack* multipliers,
                    const LanePack& turns, LanePack* residual, LanePack* magnitude, LanePack* tangent) {
  evaluate_element(e, field, multipliers, turns, residual, tangent);
  if (magnitude != nullptr) eval_magnitude(e, field, residual, magnitude);
}

/// The drivers of evaluate_lanes.hpp, and those of both forms.
template <class E>
inline constexpr auto lane_drivers =
    std::tuple{&may_share_lanes<E>, &has_same_numbers<E>, &make_lane_element<E>, &evaluate_lanes<LaneElement<E>>};
template <class E>
inline constexpr auto both_drivers = std::tuple{alone_drivers<E>, lane_drivers<E>};

}  // namespace bough::elements
