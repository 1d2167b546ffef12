#include "mode_steadiness.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bough::run {

namespace {

using step::Linearisation;
using Part = Linearisation::Part;
using Vector = std::vector<double>;

constexpr double round_off_of_products = 1e-8;  ///< relative difference of products that is round-off

/// f(motion of a node, its screw) for every node.
template <class Change>
Vector changed(const step::System& system, const Vector& x, const std::vector<motion::Frame<double>>& screws,
               Change&& change) {
  Vector y(x.size(), 0.0);
  for (std::size_t n = 0; n < screws.size(); ++n) {
    const int node = static_cast<int>(n);
    system.places().set_node_part(y.data(), node, change(screws[n], system.places().node_part(x.data(), node)));
  }
  return y;
}

/// Whether two forces differ by no more than round-off of their terms.
bool are_same(const Linearisation& linear, const Vector& a, const Vector& b, const Vector& terms) {
  const double most = *std::max_element(terms.begin(), terms.end());
  for (std::size_t i = 0; i < a.size(); ++i)
    if (linear.weights()[i] > 0.0 &&
        std::abs(a[i] - b[i]) > round_off_of_products * std::max(terms[i], round_off_of_products * most))
      return false;
  return true;
}

}  // namespace

Steadiness look_at_steadiness(step::System& system, const Linearisation& linear, const step::State& state) {
  const plan::Plan& plan = system.plan();
  const std::vector<elements::NodeMotion> nodes = step::nodes_in_space(plan, state);
  double fastest = 0.0;
  for (const elements::NodeMotion& n : nodes)
    fastest = std::max(
        {fastest, length_of(lanes::angular_part(n.v)), 0.1 * length_of(lanes::linear_part(n.v)) / plan.length_scale});
  step::State later = state;
  std::vector<motion::Frame<double>> screws;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const motion::Vec6<double> way = (1.0 / fastest) * nodes[n].v;
    step::move_node(plan, later, n, way);
    screws.push_back(motion::Se3::exp(way));
  }
  Linearisation other(system);
  if (other.take(later)) return {true, "the state moves, and that some time later cannot be evaluated"};
  Vector x(linear.size(), 0.0), now(x), then(x), terms(x);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (const double w = linear.weights()[i]; w > 0.0)
      x[i] = (1.5 + std::sin(static_cast<double>(7 * i + 1))) / std::sqrt(w);
  const Vector carried =
      changed(system, x, screws, [](const auto& S, const auto& eta) { return motion::inverse_adjoint_times(S, eta); });
  bool is_same_from_ground = true, is_same_from_parts = true;
  for (const Part part : {Part::stiffness, Part::damping, Part::mass}) {
    linear.multiply(part, x, now);
    linear.multiply_magnitudes(part, x, terms);
    other.multiply(part, x, then);
    is_same_from_parts = is_same_from_parts && are_same(linear, now, then, terms);
    other.multiply(part, carried, then);
    const Vector back = changed(system, then, screws, [](const auto& S, const auto& f) {
      return motion::inverse_adjoint_transpose_times(S, f);
    });
    is_same_from_ground =
        is_same_from_ground &&
        are_same(linear, changed(system, now, screws, [](const auto&, const auto& f) { return f; }), back, terms);
  }
  if (is_same_from_ground) return {true, ""};
  if (is_same_from_parts) return {false, ""};
  return {true,
          "the linearised equations change as parts move on, whether they are seen from the ground or from the parts: "
          "the modes are those of this instant, which no motion has; parts that turn have to be symmetric about their "
          "axes, or what holds them has to turn with them, as in a `frame` of the analysis"};
}

}  // namespace bough::run
