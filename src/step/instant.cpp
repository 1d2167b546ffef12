#include "bough/step/instant.hpp"

#include <cmath>

namespace bough::step {

using elements::CarrierMotion;
using lanes::cross;
using motion::Vec3;
using motion::Vec6;

namespace {

/// In statics the observer's frame moves steadily: the acceleration of each of its points is constant in the frame,
///   a_0 + w x (w x x),  a_0 = V_l' + w x V_l,
/// and is scaled by the load factor. A common velocity has no effect and is omitted:  V = (0; sqrt(factor) w),  V' =
/// (factor a_0; 0).
void make_steady(CarrierMotion& m, double factor) {
  const Vec3<double> w = lanes::angular_part(m.twist);
  const Vec3<double> origin = lanes::linear_part(m.twist_rate) + cross(w, lanes::linear_part(m.twist));
  const double positive = factor > 0.0 ? factor : 0.0;
  m.twist = lanes::join(Vec3<double>::zero(), std::sqrt(positive) * w);
  m.twist_rate = lanes::join(positive * origin, Vec3<double>::zero());
  m.twist_second = Vec6<double>::zero();
}

}  // namespace

Instant::Instant(const plan::Plan& plan)
    : plan_(plan), values_(plan.laws.size(), 0.0), rates_(values_), accelerations_(values_) {
  series_.resize(values_.size());
  rate_series_.resize(values_.size());
}

std::optional<Trouble> Instant::set(double time, laws::Side side) {
  time_ = time;
  side_ = side;
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    const laws::LawValue v = plan_.laws[i].law.at(plan_.laws[i].at_start ? 0.0 : time, side);
    if (const auto which = laws::non_finite(v))
      return Trouble{"the time function of '" + plan_.laws[i].user + "' is not finite at time " + std::to_string(time) +
                     ": " + *which};
    values_[i] = v.value;
    rates_[i] = v.rate;
    accelerations_[i] = v.acceleration;
  }
  if (!plan_.frames.empty()) set_frames();
  return std::nullopt;
}

elements::Field Instant::surroundings(const State& state, const elements::Slopes& slopes, bool with_inertia) const {
  for (std::size_t i = 0; i < plan_.signals.size(); ++i) note_signal(plan_.signals[i], state.signals.value[i]);
  elements::Field f;
  f.slopes = slopes;
  f.around.gravity = values_[static_cast<std::size_t>(plan_.gravity_law)] * plan_.gravity;
  f.around.laws = values_.data();
  f.around.has_inertia = plan_.is_dynamic && with_inertia;
  if (plan_.frames.empty()) return f;
  f.carriers = frames_.in_ground.data();
  f.observer = observer();
  if (f.observer == nullptr) return f;
  f.around.gravity = lanes::transpose_times(f.observer->pose.R, f.around.gravity);
  f.around.has_inertia = with_inertia;  // in statics, too: nodes are at rest in a frame that moves steadily
  return f;
}

elements::Field Instant::field(const State& state, const elements::Slopes& slopes, bool with_inertia) const {
  elements::Field f = surroundings(state, slopes, with_inertia);
  f.nodes = nodes_in_space(plan_, state).data();
  return f;
}

elements::Field Instant::field_of(const State& state, std::span<const int> nodes,
                                  std::vector<elements::NodeMotion>& scratch, const tree::Walker* walker) const {
  if (state.is_in_space()) return field(state);
  elements::Field f = surroundings(state, {}, true);
  scratch.resize(plan_.nodes.size());
  copy_nodes_in_space(plan_, state, nodes, scratch, walker);
  f.nodes = scratch.data();
  return f;
}

template <class G>
elements::FieldOn<G, double> Instant::field_on(const State& state, const elements::Slopes& slopes,
                                               bool with_inertia) const {
  if constexpr (std::is_same_v<G, motion::Se3>) {
    return field(state, slopes, with_inertia);
  } else {
    const elements::Field space = surroundings(state, slopes, with_inertia);
    elements::FieldOn<G, double> f;
    f.nodes = state.on<G>().motion.data();
    f.slopes = slopes;
    f.around.gravity = plan::along_axes<G>(plan_, space.around.gravity);
    f.around.laws = space.around.laws;
    f.around.has_inertia = space.around.has_inertia;
    return f;
  }
}
#define BOUGH_INSTANTIATE_FIELD(G) \
  template elements::FieldOn<G, double> Instant::field_on<G>(const State&, const elements::Slopes&, bool) const;
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE_FIELD)

const std::vector<lanes::Taylor<double, 1>>& Instant::rate_series() const {
  for (std::size_t i = 0; i < rate_series_.size(); ++i) {
    rate_series_[i].c[0] = values_[i];
    rate_series_[i].c[1] = rates_[i];
  }
  return rate_series_;
}

const Instant::Series& Instant::series(double step_size) const {
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    lanes::Taylor<double, 3>& s = series_[i];
    s.c[0] = values_[i];
    s.c[1] = rates_[i];
    s.c[2] = 0.5 * accelerations_[i];
    s.c[3] = 0.0;
    if (step_size > 0.0 && !plan_.laws[i].law.is_constant()) {
      const double next = plan_.laws[i].law.at(time_ + step_size, laws::Side::left).acceleration;
      if (std::isfinite(next)) s.c[3] = (next - accelerations_[i]) / (6.0 * step_size);
    }
  }
  return series_;
}

const plan::FrameMotions& Instant::frame_series(double step_size) const {
  plan::eval_frames(plan_, series(step_size).data(), series_frames_);
  return series_frames_;
}

void Instant::set_frames() {
  plan::eval_frames(plan_, series(0.0).data(), frames_);
  if (!plan_.is_dynamic) {
    for (CarrierMotion& m : frames_.in_ground) m.twist = m.twist_rate = m.twist_second = Vec6<double>::zero();
    if (plan_.observer >= 0) make_steady(frames_.observer, time_);
  }
  set_turned_laws();
}

/// f (R u)_row with R' = R ~w:  (R u)' = R (w x u),  (R u)'' = R (w' x u + w x (w x u)).
void Instant::set_turned_laws() {
  for (const plan::TurnedLawPlan& l : plan_.turned_laws) {
    const CarrierMotion& m = frames_.in_ground[static_cast<std::size_t>(l.frame)];
    const Vec3<double> w = lanes::angular_part(m.twist), along = cross(w, l.vector);
    const double u = (m.pose.R * l.vector)[l.row], du = (m.pose.R * along)[l.row];
    const double ddu =
        (m.pose.R * Vec3<double>(cross(lanes::angular_part(m.twist_rate), l.vector) + cross(w, along)))[l.row];
    const auto from = static_cast<std::size_t>(l.factor), to = static_cast<std::size_t>(l.law);
    values_[to] = values_[from] * u;
    rates_[to] = rates_[from] * u + values_[from] * du;
    accelerations_[to] = accelerations_[from] * u + 2.0 * rates_[from] * du + values_[from] * ddu;
  }
}

}  // namespace bough::step
