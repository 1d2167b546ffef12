/// Legal numbers that look like those of other units: inertia and mass centres by the parts around them, turns in rpm
/// or degrees, times in milliseconds by the motion that a step would have to follow.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bough/scene/analysis_kinds.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// Numbers beyond are told by other checks, and their squares overflow.
constexpr double overflowing = 1e100;
bool is_moderate(const Vec3& x) {
  return std::abs(x[0]) < overflowing && std::abs(x[1]) < overflowing && std::abs(x[2]) < overflowing;
}

/// Diagonal of the box around all nodes, bodies and places where joints and couplings take hold [m]; 0 if these are one
/// point.
double extent_of(const ProblemList& list) {
  Vec3 low = Vec3::zero(), high = low;
  bool is_first = true;
  const auto include = [&](const std::optional<Frame>& pose) {
    if (!pose || !is_moderate(pose->x)) return;
    for (int k = 0; k < 3; ++k) {
      low[k] = is_first ? pose->x[k] : std::min(low[k], pose->x[k]);
      high[k] = is_first ? pose->x[k] : std::max(high[k], pose->x[k]);
    }
    is_first = false;
  };
  const Scene& s = list.scene;
  for (const Node& n : s.nodes) include(list.poses.of(n.placement));
  for (const Body& b : s.bodies) include(list.poses.of(b.placement));
  const auto include_ends = [&](const auto& items) {
    for (const auto& item : items) {
      include(list.poses.of(item.first));
      include(list.poses.of(item.second));
    }
  };
  include_ends(s.joints);
  include_ends(s.couplings);
  const double size = norm(Vec3(high - low));
  return std::isfinite(size) ? size : 0.0;
}

/// A body whose radius of gyration or mass centre lies far beyond all that the scene has.
void check_body(ProblemList& list, std::size_t i, double extent) {
  constexpr double far_beyond = 10.0, least = 1.0;         // of radii [m]
  constexpr double far_off = 20.0, least_off = 5.0;        // of mass centres [m]
  constexpr double far_alone = 200.0, least_alone = 10.0;  // of mass centres over radii, where nothing else has a size
  const Body& b = list.scene.bodies[i];
  const double trace = b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2);
  if (!(b.mass > 1.0 / overflowing) || !(trace < overflowing) || !is_moderate(b.center_of_mass)) return;
  const double radius = std::sqrt(std::max(0.0, 0.5 * trace / b.mass)), off = norm(b.center_of_mass);
  const std::string in_a_scene = " m, in a scene of " + text_of(extent) + " m";
  if (radius > least && extent > 0.0 && radius > far_beyond * extent)
    list.warn("bodies", i, "inertia", b.name,
              "its radius of gyration, sqrt(inertia / mass), is " + text_of(radius) + in_a_scene,
              "is it meant? inertia is asked for in kg m^2: 1 kg mm^2 is 1e-6, 1 g cm^2 is 1e-7");
  const bool is_off = extent > 0.0 ? off > least_off && off > far_off * extent
                                   : off > least_alone && trace > 0.0 && off > far_alone * radius;
  if (is_off)
    list.warn("bodies", i, "center_of_mass", b.name,
              "its mass centre lies " + text_of(off) +
                  (extent > 0.0 ? in_a_scene : " m away, and its radius of gyration is " + text_of(radius) + " m"),
              "is it given in mm? it is asked for in metres");
}

/// Largest magnitude of a law, or of its rate, over the analysis, by samples and at its breakpoints.
double largest_over_time(const ProblemList& list, const laws::Law& law, bool of_rate) {
  constexpr int samples = 200;
  double most = 0.0;
  // The value of an integral by quadrature costs the whole way to that time; its rate is the integrand.
  const std::optional<laws::Law> integrand = law.node() == nullptr ? std::nullopt : law.integrand();
  if (integrand && !of_rate) return most;
  const auto look = [&](double t, laws::Side side) {
    const double x = std::abs(integrand ? integrand->at(t, side).value
                              : of_rate ? law.at(t, side).rate
                                        : law.at(t, side).value);
    if (std::isless(x, overflowing)) most = std::max(most, x);  // a law may be no number there
  };
  if (law.node() == nullptr || !std::isfinite(list.last_time)) return most;
  for (int k = 0; k <= samples; ++k) look(list.last_time * k / samples, laws::Side::right);
  return most;
}

/// An angular velocity that looks like revolutions per minute: whole tens, and so fast that a step turns far.
void check_turning(ProblemList& list, const char* section, std::size_t i, const std::string& key,
                   const std::string& name, double rate) {
  constexpr double in_rad = 0.10471975511965977, least = 300.0, tens = 10.0;
  constexpr double far_if_round = 0.1, far = 1.0;  // rad in a step
  if (!list.is_dynamic || !(rate > 0.0) || !(list.scene.analysis.step_size < overflowing)) return;
  const double turn = rate * list.scene.analysis.step_size;
  const bool is_round = rate >= least && std::abs(rate - tens * std::round(rate / tens)) <= 1e-9 * rate;
  if (!(turn > far) && !(is_round && turn > far_if_round)) return;
  list.warn(section, i, key, name,
            "an angular velocity of " + text_of(rate) + " rad/s turns by " + text_of(turn) + " rad in a step of " +
                text_of(list.scene.analysis.step_size) + " s",
            is_round ? "is it given in rpm? " + text_of(rate) + " rpm are " + text_of(in_rad * rate) + " rad/s"
                     : "take smaller steps, or look at the unit: it is rad/s");
}

/// An angle that reaches a number of degrees that people give, and does not turn on there.
void check_angle(ProblemList& list, const char* section, std::size_t i, const std::string& key, const std::string& name,
                 const laws::Law& law) {
  constexpr std::array<double, 9> usual{30, 45, 60, 90, 120, 135, 180, 270, 360};
  if (!list.is_dynamic || law.is_constant()) return;  // constants and laws of statics are looked at where they are read
  const double most = largest_over_time(list, law, false);
  const auto* const found =
      std::find_if(usual.begin(), usual.end(), [most](double x) { return std::abs(most - x) <= 1e-4 * x; });
  if (found == usual.end()) return;
  const laws::LawValue end = law.at(list.scene.analysis.end_time);
  if (end.rate == 0.0 || std::abs(end.value) < (1.0 - 1e-4) * most)
    list.warn(section, i, key, name, "this angle reaches " + text_of(*found) + " rad",
              "is it given in degrees? in a formula multiply by pi/180 = 0.017453292519943295");
}

void check_turns(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.initial_velocities.size(); ++i)
    if (is_moderate(s.initial_velocities[i].angular_velocity))
      check_turning(list, "initial_velocities", i, "angular_velocity", s.initial_velocities[i].of,
                    norm(s.initial_velocities[i].angular_velocity));
  const auto check = [&](const char* section, std::size_t i, const std::string& key, const std::string& name,
                         const laws::Law& law, bool is_rate) {
    check_turning(list, section, i, key, name, largest_over_time(list, law, !is_rate));
    if (!is_rate) check_angle(list, section, i, key, name, law);
  };
  for (std::size_t i = 0; i < s.joints.size(); ++i)
    for (std::size_t k = 0; k < s.joints[i].drives.size(); ++k) {
      const JointDrive& d = s.joints[i].drives[k];
      const JointCoordinate* coordinate = type_of(s.joints[i].kind).coordinate(d.coordinate);
      if (coordinate != nullptr && !coordinate->is_length())
        check("joints", i, "drives/" + std::to_string(k) + "/law", s.joints[i].name, d.law, d.is_rate);
    }
  for (std::size_t i = 0; i < s.motions.size(); ++i)
    if (s.motions[i].rotation_axis)
      check("motions", i, "rotation/angle", s.motions[i].name, s.motions[i].angle, s.motions[i].is_rate);
  for (std::size_t i = 0; i < s.frames.size(); ++i)
    for (std::size_t k = 0; s.frames[i].motion && k < s.frames[i].motion->turns.size(); ++k)
      check("frames", i, "motion/turns/" + std::to_string(k) + "/angle", s.frames[i].name,
            s.frames[i].motion->turns[k].angle, false);
}

/// Times in milliseconds: a step in which a body of the size of the scene would fall by more than its own size, or an
/// end time of a whole number of hundreds that takes hundreds of thousands of steps of a millisecond.
void check_times(ProblemList& list, double extent) {
  constexpr double many = 2e5, fall = 9.81;
  const Analysis& a = list.scene.analysis;
  if (!list.is_dynamic || type_of(a.kind).is_of_instant || !(a.step_size > 0.0) || !(a.step_size < overflowing) ||
      a.step_control)
    return;
  const double longest = std::sqrt(2.0 * extent / fall);
  if (extent > 0.0 && a.step_size > longest && a.step_size >= 0.1)
    list.warn("analysis", 0, "step_size", text_of(a.step_size),
              "a step of " + text_of(a.step_size) + " s is long in a scene of " + text_of(extent) +
                  " m: in this time a body falls by " + text_of(0.5 * fall * a.step_size * a.step_size) + " m",
              "is it given in milliseconds? times are asked for in seconds");
  const double steps = a.end_time / a.step_size;
  if (steps >= many && a.end_time >= 200.0 && std::fmod(a.end_time, 100.0) == 0.0 && a.step_size <= 1e-3)
    list.warn("analysis", 0, "end_time", text_of(a.end_time),
              "the run lasts " + text_of(a.end_time) + " s in steps of " + text_of(a.step_size) + " s",
              "is the end time given in milliseconds? times are asked for in seconds");
}

}  // namespace

void check_units(ProblemList& list) {
  const double extent = extent_of(list);
  for (std::size_t i = 0; i < list.scene.bodies.size(); ++i) check_body(list, i, extent);
  check_turns(list);
  check_times(list, extent);
}

}  // namespace bough::scene
