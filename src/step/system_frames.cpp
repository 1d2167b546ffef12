/// System: frames whose motion is prescribed.
#include <cmath>

#include "bough/step/system.hpp"
#include "lane_batches.hpp"

namespace bough::step {

using elements::CarrierMotion;
using lanes::cross;
using motion::Vec3;
using motion::Vec6;

namespace {

/// The observer of statics moves steadily: every point of its frame has an acceleration that does not change in it,
///   a_0 + w x (w x x),  a_0 = V_l' + w x V_l,
/// and the load factor scales it. A common velocity changes nothing, so it is left out:  V = (0; sqrt(factor) w),  V' = (factor a_0; 0).
void make_steady(CarrierMotion& m, double factor) {
  const Vec3<double> w = lanes::angular_part(m.twist);
  const Vec3<double> origin = lanes::linear_part(m.twist_rate) + cross(w, lanes::linear_part(m.twist));
  const double positive = factor > 0.0 ? factor : 0.0;
  m.twist = lanes::join(Vec3<double>::zero(), std::sqrt(positive) * w);
  m.twist_rate = lanes::join(positive * origin, Vec3<double>::zero());
  m.twist_second = Vec6<double>::zero();
}

}  // namespace

/// Laws as series with what is known of them; third derivatives by a difference over the step to come, as of constraints.
void System::set_frame_series(double step_size, plan::FrameMotions& motions) const {
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    lanes::Taylor<double, 3>& s = law_series_[i];
    s.c[0] = law_values_[i];
    s.c[1] = law_rates_[i];
    s.c[2] = 0.5 * law_accelerations_[i];
    s.c[3] = 0.0;
    if (step_size > 0.0 && !plan_.laws[i].law.is_constant()) {
      const double next = plan_.laws[i].law.at(time_ + step_size, laws::Side::left).acceleration;
      if (std::isfinite(next)) s.c[3] = (next - law_accelerations_[i]) / (6.0 * step_size);
    }
  }
  plan::eval_frames(plan_, law_series_.data(), motions);
}

void System::set_frames() {
  set_frame_series(0.0, frames_);
  if (!plan_.is_dynamic) {
    for (CarrierMotion& m : frames_.in_ground) m.twist = m.twist_rate = m.twist_second = Vec6<double>::zero();
    if (plan_.observer >= 0) make_steady(frames_.observer, time_);
  }
  spatial_lanes_->set_frames(frames_);
  set_turned_laws();
}

/// f (R u)_row with R' = R ~w:  (R u)' = R (w x u),  (R u)'' = R (w' x u + w x (w x u)).
void System::set_turned_laws() {
  for (const plan::TurnedLawPlan& l : plan_.turned_laws) {
    const CarrierMotion& m = frames_.in_ground[static_cast<std::size_t>(l.frame)];
    const Vec3<double> w = lanes::angular_part(m.twist), along = cross(w, l.vector);
    const double u = (m.pose.R * l.vector)[l.row], du = (m.pose.R * along)[l.row];
    const double ddu =
        (m.pose.R * Vec3<double>(cross(lanes::angular_part(m.twist_rate), l.vector) + cross(w, along)))[l.row];
    const auto from = static_cast<std::size_t>(l.factor), to = static_cast<std::size_t>(l.law);
    law_values_[to] = law_values_[from] * u;
    law_rates_[to] = law_rates_[from] * u + law_values_[from] * du;
    law_accelerations_[to] = law_accelerations_[from] * u + 2.0 * law_rates_[from] * du + law_values_[from] * ddu;
  }
}

}  // namespace bough::step
