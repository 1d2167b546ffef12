#include "given_velocities.hpp"

#include <algorithm>
#include <cmath>

namespace bough::run {

namespace {

using motion::Vec3;
using motion::Vec6;

constexpr double round_off = 1e-9;  ///< relative to the largest speed; starts are consistent to some 1e-10

/// Largest entry, lengths relative to the size of the structure [1/s].
double speed_of(const Vec6<double>& twist, double length) {
  return std::max(length_of(lanes::linear_part(twist)) / length, length_of(lanes::angular_part(twist)));
}

}  // namespace

std::vector<records::ChangedVelocity> changed_velocities(const plan::Plan& plan, const step::State& start,
                                                         const std::vector<elements::NodeMotion>& moved) {
  const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan, start);
  double speed = 0.0;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    speed =
        std::max({speed, speed_of(plan.nodes[n].twist, plan.length_scale), speed_of(nodes[n].v, plan.length_scale)});
  std::vector<records::ChangedVelocity> changed;
  const auto compare = [&](const std::string& of, bool is_angular, const Vec3<double>& asked, const Vec3<double>& got) {
    if (length_of(asked) == 0.0) return;  // not given
    const double change = length_of(Vec3<double>(got - asked)) / (is_angular ? speed : speed * plan.length_scale);
    if (change <= std::max(round_off, plan.disagreement())) return;
    const auto known = std::find_if(changed.begin(), changed.end(), [&](const records::ChangedVelocity& c) {
      return c.of == of && c.is_angular == is_angular;
    });
    if (known != changed.end() && known->change >= change) return;
    records::ChangedVelocity& to = known != changed.end() ? *known : changed.emplace_back();
    to = {of, is_angular, {asked[0], asked[1], asked[2]}, {got[0], got[1], got[2]}, change};
  };
  for (const plan::GivenVelocity& given : plan.given_velocities) {
    const auto n = static_cast<std::size_t>(given.node);
    const motion::Mat3<double> R = (moved.empty() ? plan.nodes[n].pose.R : moved[n].R) * given.offset.R;
    const Vec6<double>& given_twist = moved.empty() ? plan.nodes[n].twist : moved[n].v;
    const Vec6<double> asked = motion::inverse_adjoint_times(given.offset, given_twist),
                       got = motion::inverse_adjoint_times(given.offset, nodes[n].v);
    compare(given.of, false, R * lanes::linear_part(asked), R * lanes::linear_part(got));
    if (given.has_angular) compare(given.of, true, R * lanes::angular_part(asked), R * lanes::angular_part(got));
  }
  std::stable_sort(changed.begin(), changed.end(), [](const auto& a, const auto& b) { return a.change > b.change; });
  return changed;
}

}  // namespace bough::run
