#include "bough/scene/moving_frame.hpp"

namespace bough::scene {

motion::FrameMotion motion_at(const MovingFrame& frame, double t, laws::Side side) {
  motion::FrameMotion m;
  for (int k = 0; k < 3; ++k) {
    const laws::LawValue x = frame.position[k].at(t, side);
    m.pose.x[k] = x.value;
    m.velocity[k] = x.rate;
    m.acceleration[k] = x.acceleration;
  }
  m.pose.R = frame.rotation;
  for (const Turn& turn : frame.turns) {
    const laws::LawValue angle = turn.angle.at(t, side);
    const motion::Vec3<double> axis = m.pose.R * turn.axis, u = angle.rate * axis;
    m.angular_acceleration += angle.acceleration * axis + cross(m.angular_velocity, u);
    m.angular_velocity += u;
    m.pose.R = m.pose.R * motion::exp_so3(angle.value * turn.axis);
  }
  return m;
}

std::optional<std::string> non_finite_law(const MovingFrame& frame, double t) {
  const auto told = [&](const laws::Law& law, const std::string& what) -> std::optional<std::string> {
    const std::optional<std::string> fault = laws::non_finite(law.at(t));
    if (!fault) return std::nullopt;
    return what + " of frame \"" + frame.name + "\": " + *fault;
  };
  for (int k = 0; k < 3; ++k)
    if (auto text = told(frame.position[k], std::string("position ") + "xyz"[k])) return text;
  for (std::size_t k = 0; k < frame.turns.size(); ++k)
    if (auto text = told(frame.turns[k].angle, "turn " + std::to_string(k + 1))) return text;
  return std::nullopt;
}

double time_of(const FrameStudy& study, int k) {
  const double part = static_cast<double>(k) / (study.num_points - 1);
  return (1.0 - part) * study.start_time + part * study.end_time;
}

}  // namespace bough::scene
