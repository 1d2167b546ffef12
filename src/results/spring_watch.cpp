#include "bough/results/spring_watch.hpp"

#include <cmath>
#include <cstdio>

#include "bough/elements/evaluate.hpp"
#include "observe_parts.hpp"

namespace bough::results {

namespace {

using motion::Vec3;

constexpr double along = 0.9;  ///< cosine of the angle between a velocity and a line that counts as along it

double cosine(const Vec3<double>& a, const Vec3<double>& b) {
  const double sizes = std::sqrt(lanes::dot(a, a) * lanes::dot(b, b));
  return sizes > 0.0 ? lanes::dot(a, b) / sizes : 0.0;
}

}  // namespace

SpringWatch::SpringWatch(const plan::Plan& plan) {
  for (std::size_t id = 0; plan.is_dynamic && id < plan.directory.size(); ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      if constexpr (std::decay_t<decltype(e)>::acts_along_line)
        if (e.rest_length > 0.0 && e.stiffness > 0.0)
          seen_.push_back({{e.ports[0], e.ports[1]}, plan.element_owner[id]});
    });
}

Vec3<double> SpringWatch::rate_of(const Seen& s, const elements::Field& f) {
  const auto anchor = elements::anchor_of(s, f.nodes);
  const auto a = elements::eval_port(s.ports[0], f.nodes, anchor, f.carriers),
             b = elements::eval_port(s.ports[1], f.nodes, anchor, f.carriers);
  return b.H.R * lanes::linear_part(b.v) - a.H.R * lanes::linear_part(a.v);
}

/// Positions decide most cases. Velocities are used where the line has reversed, and in the first call.
void SpringWatch::look(const step::System& system, const step::State& state) {
  if (seen_.empty() || passed_) return;
  const elements::Field f = system.instant().field(state);
  for (Seen& s : seen_) {
    const Vec3<double> span = position_of(f, s.ports[1]) - position_of(f, s.ports[0]);
    if (!is_first_ && lanes::dot(span, s.span) < 0.0 && cosine(s.approach, s.span) < -along &&
        cosine(rate_of(s, f), span) > along) {
      passed_ = static_cast<std::size_t>(&s - seen_.data());
      time_ = state.time;
      return;
    }
    s.approach = is_first_ ? rate_of(s, f) : span - s.span;
    s.span = span;
  }
  is_first_ = false;
}

std::string SpringWatch::text() const {
  if (!passed_) return "";
  char time[32];
  std::snprintf(time, sizeof time, "%.6g", time_);
  return "spring '" + seen_[*passed_].name + "' has passed through length 0 by time " + time +
         ": its force has no direction there and turns round at once; hold the point beside the line, use a bushing, "
         "or a rest length of 0";
}

}  // namespace bough::results
