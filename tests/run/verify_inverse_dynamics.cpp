// Inverse dynamics against closed forms and Newton-Euler; what forward dynamics makes of its efforts; refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bough/plan/undriven.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

const std::string in_space = "/without=[\"planar\", \"translation\", \"line\"]";

/// A function of time with its first two derivatives.
struct Motion {
  double value, rate, acceleration;
};

// Two links in a vertical plane, hung at their ends; angles 0.7 (1 - cos 3t) and -1.1 (1 - cos 2t).
constexpr double m1 = 2.0, m2 = 1.5, J1 = 0.08, J2 = 0.05, l1 = 0.9, c1 = 0.4, c2 = 0.35, g = 9.81;

Motion shoulder(double t) {
  return {0.7 * (1.0 - std::cos(3.0 * t)), 2.1 * std::sin(3.0 * t), 6.3 * std::cos(3.0 * t)};
}
Motion elbow(double t) {
  return {-1.1 * (1.0 - std::cos(2.0 * t)), -2.2 * std::sin(2.0 * t), -4.4 * std::cos(2.0 * t)};
}

/// Torques of the arm, angles counted from the horizontal, that of the elbow relative to the upper arm.
std::array<double, 2> torques_of_arm(const Motion& q, const Motion& p) {
  const double h = l1 * c2, c = std::cos(p.value), s = std::sin(p.value);
  const double m11 = J1 + m1 * c1 * c1 + J2 + m2 * (l1 * l1 + c2 * c2 + 2.0 * h * c), m12 = J2 + m2 * (c2 * c2 + h * c),
               m22 = J2 + m2 * c2 * c2;
  const double fore = m2 * g * c2 * std::cos(q.value + p.value);
  return {m11 * q.acceleration + m12 * p.acceleration - m2 * h * s * p.rate * (2.0 * q.rate + p.rate) +
              (m1 * c1 + m2 * l1) * g * std::cos(q.value) + fore,
          m12 * q.acceleration + m22 * p.acceleration + m2 * h * s * q.rate * q.rate + fore};
}

std::string arm(const std::string& analysis, const std::string& at_shoulder, const std::string& at_elbow,
                const std::string& more = "") {
  return R"-({"analysis": {)-" + analysis + R"-(}, "gravity": [0, -9.81, 0],
  "bodies": [
    {"name": "upper", "position": [0, 0, 0], "mass": 2, "center_of_mass": [0.4, 0, 0], "inertia": [0.05, 0.08, 0.08]},
    {"name": "fore", "position": [0.9, 0, 0], "mass": 1.5, "center_of_mass": [0.35, 0, 0],
     "inertia": [0.03, 0.05, 0.05]}],
  "joints": [
    {"name": "shoulder", "kind": "revolute", "first": "ground", "second": "upper", "axis": [0, 0, 1])-" +
         at_shoulder + R"-(},
    {"name": "elbow", "kind": "revolute", "first": "upper", "second": "fore", "position": [0.9, 0, 0],
     "axis": [0, 0, 1])-" +
         at_elbow + R"-(}])-" + more + R"-(,
  "sensors": [{"name": "shoulder", "kind": "joint_angle", "joint": "shoulder"},
              {"name": "elbow", "kind": "joint_angle", "joint": "elbow"},
              {"name": "rate", "kind": "joint_rate", "joint": "elbow"},
              {"name": "tip", "kind": "acceleration", "at": "fore"})-";
}

const std::string shoulder_drive = R"-(, "drives": [{"law": {"expression": "0.7*(1 - cos(3*t))"}}])-";
const std::string elbow_drive = R"-(, "drives": [{"law": {"expression": "-1.1*(1 - cos(2*t))"}}])-";
const std::string efforts = R"(, "signals": [{"name": "m_shoulder", "kind": "joint_effort", "joint": "shoulder"},
  {"name": "m_elbow", "kind": "joint_effort", "joint": "elbow"}])";
const std::string effort_sensors = R"(, {"name": "m_shoulder", "kind": "signal", "signal": "m_shoulder"},
  {"name": "m_elbow", "kind": "signal", "signal": "m_elbow"}]})";

std::string inverse(double end, double step) {
  return R"("kind": "inverse_dynamics", "end_time": )" + support::text(end) + R"(, "step_size": )" +
         support::text(step);
}

std::string driven_arm(double end, double step) {
  return arm(inverse(end, step), shoulder_drive, elbow_drive, efforts) + effort_sensors;
}

// Round-off of the closing of joints, 1e-13 of the size of the parts, and of torques of some 50 N m.
TEST(InverseDynamics, of_a_planar_arm_is_its_closed_form) {
  for (const bool planar : {true, false}) {
    SCOPED_TRACE(planar ? "in a plane" : "in space");
    const Outcome out = run_ok(
        scene_of(driven_arm(2.0, 0.25), planar ? std::vector<std::string>{} : std::vector<std::string>{in_space}));
    ASSERT_EQ(out.history.times.size(), 9u);
    for (const double t : out.history.times) {
      const Motion q = shoulder(t), p = elbow(t);
      const std::array<double, 2> torques = torques_of_arm(q, p);
      EXPECT_NEAR(out.history.at("m_shoulder", t), torques[0], 2e-11) << t;
      EXPECT_NEAR(out.history.at("m_elbow", t), torques[1], 2e-11) << t;
      EXPECT_NEAR(out.history.at("shoulder", t), q.value, 1e-12);
      EXPECT_NEAR(out.history.at("elbow", t), p.value, 1e-12);
      EXPECT_NEAR(out.history.at("rate", t), p.rate, 1e-11);
    }
    EXPECT_EQ(out.summary.steps.accepted, 8);
    EXPECT_TRUE(out.summary.doubts.empty());
    EXPECT_TRUE(out.summary.not_judged.empty()) << out.summary.not_judged;
    EXPECT_EQ(out.summary.checks.energy_scale, 0.0);  // nothing was summed
  }
}

// No time is integrated: the times asked for, those of figures included, change nothing.
TEST(InverseDynamics, at_a_time_does_not_depend_on_the_others) {
  const std::string figures =
      R"(, "expected": [{"quantity": "m_elbow", "time": 0.7, "value": 0, "tolerance": 1, "source": "none"}])";
  std::string json = driven_arm(2.0, 2.0);
  json.insert(json.rfind('}'), figures);
  const Outcome coarse = run_ok(scene_of(json)), fine = run_ok(scene_of(driven_arm(2.0, 0.01)));
  ASSERT_EQ(coarse.history.times.size(), 3u);  // 0, 0.7, 2
  for (const double t : {0.7, 2.0})
    for (const char* column : {"m_shoulder", "m_elbow", "tip.ax", "tip.ay"})
      EXPECT_NEAR(coarse.history.at(column, t), fine.history.at(column, t), 2e-11) << column << " at " << t;
  EXPECT_NEAR(coarse.summary.expected.at(0).value, torques_of_arm(shoulder(0.7), elbow(0.7))[1], 2e-11);
}

using Vector = std::array<long double, 3>;

Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator*(long double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// v turned by an angle about z or x.
Vector about_z(long double a, const Vector& v) {
  return {std::cos(a) * v[0] - std::sin(a) * v[1], std::sin(a) * v[0] + std::cos(a) * v[1], v[2]};
}
Vector about_x(long double a, const Vector& v) {
  return {v[0], std::cos(a) * v[1] - std::sin(a) * v[2], std::sin(a) * v[1] + std::cos(a) * v[2]};
}

// A body with three different moments of inertia, off-centre, is carried along three axes and turned by three gimbals
// without mass: angles a about z, b about the new x, c about the newest z. Newton-Euler in long double:
//   F = m (p'' + w' x r + w x (w x r) - g),  M = r x F + R (J w_b' + w_b x J w_b)  about the crossing of the axes,
//   w = a' z + b' x_1 + c' z_2,  the torque of a gimbal is the component of M along its axis.
TEST(InverseDynamics, of_a_body_in_space_is_that_of_newton_and_euler) {
  const std::string json = R"-({"analysis": {)-" + inverse(1.5, 0.1) + R"-(}, "gravity": [1, -2, -9],
  "nodes": [{"name": "A"}, {"name": "B"}, {"name": "C"}, {"name": "D"}, {"name": "E"}],
  "bodies": [{"name": "body", "mass": 3, "center_of_mass": [0.2, -0.1, 0.3], "inertia": [0.3, 0.5, 0.7]}],
  "joints": [
    {"name": "along_x", "kind": "prismatic", "first": "ground", "second": "A", "axis": [1, 0, 0],
     "drives": [{"law": {"expression": "0.5*sin(2*t)"}}]},
    {"name": "along_y", "kind": "prismatic", "first": "A", "second": "B", "axis": [0, 1, 0],
     "drives": [{"law": {"expression": "0.3*t^2"}}]},
    {"name": "along_z", "kind": "prismatic", "first": "B", "second": "C", "axis": [0, 0, 1],
     "drives": [{"law": {"expression": "0.2*cos(3*t) - 0.2"}}]},
    {"name": "outer", "kind": "revolute", "first": "C", "second": "D", "axis": [0, 0, 1],
     "drives": [{"law": {"expression": "4*t + 0.5*t^2"}}]},
    {"name": "middle", "kind": "revolute", "first": "D", "second": "E", "axis": [1, 0, 0],
     "drives": [{"law": {"expression": "0.8*sin(1.5*t)"}}]},
    {"name": "inner", "kind": "revolute", "first": "E", "second": "body", "axis": [0, 0, 1],
     "drives": [{"law": {"expression": "-7*t + sin(t)"}}]}],
  "signals": [{"name": "f_x", "kind": "joint_effort", "joint": "along_x"},
    {"name": "f_y", "kind": "joint_effort", "joint": "along_y"},
    {"name": "f_z", "kind": "joint_effort", "joint": "along_z"},
    {"name": "m_a", "kind": "joint_effort", "joint": "outer"},
    {"name": "m_b", "kind": "joint_effort", "joint": "middle"},
    {"name": "m_c", "kind": "joint_effort", "joint": "inner"}],
  "sensors": [{"name": "f_x", "kind": "signal", "signal": "f_x"}, {"name": "f_y", "kind": "signal", "signal": "f_y"},
    {"name": "f_z", "kind": "signal", "signal": "f_z"}, {"name": "m_a", "kind": "signal", "signal": "m_a"},
    {"name": "m_b", "kind": "signal", "signal": "m_b"}, {"name": "m_c", "kind": "signal", "signal": "m_c"},
    {"name": "turn", "kind": "joint_angle", "joint": "inner"}]})-";
  const Outcome out = run_ok(scene_of(json));
  ASSERT_EQ(out.history.times.size(), 16u);
  for (const double time : out.history.times) {
    const long double t = time;
    const long double a = 4 * t + 0.5L * t * t, da = 4 + t, dda = 1, b = 0.8L * std::sin(1.5L * t),
                      db = 1.2L * std::cos(1.5L * t), ddb = -1.8L * std::sin(1.5L * t), c = -7 * t + std::sin(t),
                      dc = -7 + std::cos(t), ddc = -std::sin(t);
    const auto turned = [&](const Vector& v) { return about_z(a, about_x(b, about_z(c, v))); };
    const Vector z{0, 0, 1}, x1 = about_z(a, {1, 0, 0}), z2 = about_z(a, about_x(b, z));
    const Vector w1 = da * z, w2 = w1 + db * x1, w = w2 + dc * z2;
    const Vector dw = dda * z + ddb * x1 + db * cross(w1, x1) + ddc * z2 + dc * cross(w2, z2);
    const Vector ex = turned({1, 0, 0}), ey = turned({0, 1, 0}), ez = turned(z);
    const auto inertia = [&](const Vector& v) {
      return 0.3L * dot(ex, v) * ex + 0.5L * dot(ey, v) * ey + 0.7L * dot(ez, v) * ez;
    };
    const Vector r = turned({0.2L, -0.1L, 0.3L});
    const Vector carried{-2 * std::sin(2 * t), 0.6L, -1.8L * std::cos(3 * t)}, gravity{1, -2, -9};
    const Vector force = 3.0L * (carried + cross(dw, r) + cross(w, cross(w, r)) + -1.0L * gravity);
    const Vector moment = cross(r, force) + inertia(dw) + cross(w, inertia(w));
    const auto near = [&](const char* column, long double value) {
      EXPECT_NEAR(out.history.at(column, time), static_cast<double>(value), 1e-10) << column << " at " << time;
    };
    near("f_x", force[0]);
    near("f_y", force[1]);
    near("f_z", force[2]);
    near("m_a", dot(moment, z));
    near("m_b", dot(moment, x1));
    near("m_c", dot(moment, z2));
    near("turn", c);
  }
}

/// The arm, moved by the torques that inverse dynamics has given every `step` seconds: where the elbow is at the end.
double elbow_under_torques(const Outcome& given, double step, const std::string& integrator) {
  const auto table = [&](const char* column) {
    const auto list = [](const std::vector<double>& numbers) {
      std::string text;
      for (const double x : numbers) text += (text.empty() ? "" : ", ") + support::text(x);
      return text;
    };
    return R"(, "forces": [{"effort": {"kind": "table", "interpolation": "cubic", "times": [)" +
           list(given.history.times) + R"(], "values": [)" + list(given.history.of(column)) + "]}}]";
  };
  const Outcome out = run_ok(scene_of(arm(R"("kind": "dynamic", "tolerance": 1e-11, "end_time": 1, "integrator": ")" +
                                              integrator + R"(", "step_size": )" + support::text(step),
                                          table("m_shoulder"), table("m_elbow")) +
                                      "]}"));
  return out.history.last("elbow");
}

TEST(InverseDynamics, gives_torques_under_which_the_arm_moves_as_prescribed) {
  const Outcome given = run_ok(scene_of(driven_arm(1.0, 0.0025)));
  const auto error = [&](double step, const char* integrator) {
    return std::abs(elbow_under_torques(given, step, integrator) - elbow(1.0).value);
  };
  EXPECT_NEAR(std::log2(error(0.01, "generalized_alpha") / error(0.005, "generalized_alpha")), 2.0, 0.15);
  EXPECT_NEAR(std::log2(error(0.01, "bdf") / error(0.005, "bdf")), 3.0, 0.3);
}

/// A door of 8 kg on two hinges along one axis: five of ten rows say what others say.
std::string door(const std::string& more = "") {
  return R"-({"analysis": {)-" + inverse(1.0, 0.1) + R"-(}, "gravity": [0, 0, -9.81],
  "bodies": [{"name": "door", "mass": 8, "center_of_mass": [0.4, 0, 0], "inertia": [1.1, 1.5, 0.45]}],
  "joints": [
    {"name": "lower", "kind": "revolute", "first": "ground", "second": "door", "position": [0, 0, -0.75],
     "axis": [0, 0, 1], "drives": [{"law": {"expression": "0.6*t^2"}}])-" +
         more + R"-(},
    {"name": "upper", "kind": "revolute", "first": "ground", "second": "door", "position": [0, 0, 0.75],
     "axis": [0, 0, 1]}],
  "signals": [{"name": "torque", "kind": "joint_effort", "joint": "lower"}],
  "sensors": [{"name": "torque", "kind": "signal", "signal": "torque"},
    {"name": "lower", "kind": "joint_reaction", "joint": "lower"},
    {"name": "upper", "kind": "joint_reaction", "joint": "upper"}]})-";
}

// What is unique is exact: the torque J w' about the axis, the weight and the centripetal force shared by both hinges,
// and the moment that the weight needs. Least norm shares equally between equal rows, and the run says so.
// The form monolithic regularises what is singular, and its rank is that of the same matrix in the form local.
class RedundantRows : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Forms, RedundantRows, testing::Values("local", "monolithic"));

TEST_P(RedundantRows, share_loads_by_least_norm_and_the_run_says_so) {
  const Outcome out = run_ok(scene_of(door(), {in_space, std::string("/solver/form=") + GetParam()}));
  for (const double t : out.history.times) {
    const double w = 1.2 * t, angle = 0.6 * t * t, dw = 1.2;
    EXPECT_NEAR(out.history.at("torque", t), (0.45 + 8.0 * 0.16) * dw, 1e-11);
    const double fx = 8.0 * 0.4 * (-w * w * std::cos(angle) - dw * std::sin(angle)),
                 fy = 8.0 * 0.4 * (-w * w * std::sin(angle) + dw * std::cos(angle)), fz = 8.0 * 9.81;
    const auto sum = [&](const char* part) {
      return out.history.at(std::string("lower.") + part, t) + out.history.at(std::string("upper.") + part, t);
    };
    EXPECT_NEAR(sum("fx"), fx, 1e-11);
    EXPECT_NEAR(sum("fy"), fy, 1e-11);
    EXPECT_NEAR(sum("fz"), fz, 1e-11);
    EXPECT_NEAR(out.history.at("lower.fz", t), 0.5 * fz, 1e-10);
    EXPECT_NEAR(out.history.at("upper.fz", t), 0.5 * fz, 1e-10);
  }
  const auto says = [&](const char* words) {
    return std::any_of(out.summary.notes.begin(), out.summary.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says("5 constraint row(s) depend on others"));
  EXPECT_TRUE(says("those of least norm are given"));
  EXPECT_FALSE(says("passes a singular position"));
}

// Ten turns between two times: turns are counted on the way.
TEST(InverseDynamics, counts_turns_between_distant_times) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {)-" + inverse(1.0, 1.0) + R"-(},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
    "drives": [{"law": {"kind": "smooth_ramp", "end_time": 1, "to": 62.8}}]}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"}]})-"));
  ASSERT_EQ(out.history.times.size(), 2u);
  EXPECT_NEAR(out.history.last("angle"), 62.8, 1e-11);
}

// At the end of a table that stops there, the acceleration is the one on the way, as in dynamics.
TEST(InverseDynamics, gives_the_left_limit_where_laws_jump) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {)-" + inverse(1.0, 0.5) + R"-(},
  "bodies": [{"name": "cart", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "cart", "axis": [1, 0, 0],
    "drives": [{"law": {"expression": "1.5*t^2*step(1 - t) + (3*t - 1.5)*step(t - 1)"}}]}],
  "signals": [{"name": "force", "kind": "joint_effort", "joint": "rail"}],
  "sensors": [{"name": "force", "kind": "signal", "signal": "force"}]})-"));
  EXPECT_NEAR(out.history.at("force", 0.5), 6.0, 1e-12);
  EXPECT_NEAR(out.history.at("force", 1.0), 6.0, 1e-12);
}

/// The motions for which a scene is refused.
std::string refused(const std::string& json) {
  const scene::Scene scene = scene_of(json);
  std::string texts;
  for (const std::string& text : plan::undriven_motions(scene, plan::make_plan(scene))) texts += text + "\n";
  return texts;
}

bool holds(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

TEST(InverseDynamics, is_refused_where_something_moves_on_its_own) {
  const std::string free_elbow = arm(inverse(1, 0.1), shoulder_drive, "") + "]}";
  EXPECT_TRUE(holds(refused(free_elbow), "'fore' can still turn about the axis (0, 0, 1)")) << refused(free_elbow);
  EXPECT_TRUE(holds(refused(free_elbow), "at joint 'elbow'"));
  const Outcome out = support::run(scene_of(free_elbow));
  EXPECT_FALSE(out.ok());
  EXPECT_TRUE(holds(out.summary.cause, "at joint 'elbow'")) << out.summary.cause;
  const std::string lagged = arm(inverse(1, 0.1), shoulder_drive, elbow_drive,
                                 R"(, "signals": [{"name": "lag", "kind": "state", "expression": "-lag"}])") +
                             "]}";
  EXPECT_TRUE(holds(refused(lagged), "the state 'lag' follows from its past")) << refused(lagged);
  EXPECT_EQ(refused(driven_arm(1, 0.1)), "");
  const std::string beam = R"-({"analysis": {)-" + inverse(1, 0.1) + R"-(},
  "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
  "sections": [{"name": "bar", "stiffness": {"EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 10, "EI2": 20, "EI3": 30},
    "mass": {"mass_per_length": 2, "rotary": [0.2, 0.1, 0.1]}}],
  "beams": [{"name": "rod", "section": "bar", "start": "root", "end": "tip", "elements": 2}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}]})-";
  EXPECT_TRUE(holds(refused(beam), "beam 'rod' bends")) << refused(beam);
  const std::string floating = R"-({"analysis": {)-" + inverse(1, 0.1) + R"-(},
  "bodies": [{"name": "stone", "mass": 1, "inertia": [0.1, 0.2, 0.25]}]})-";
  EXPECT_TRUE(holds(refused(floating), "nothing joins 'stone' to the ground")) << refused(floating);
  std::string open_door = door();  // hangs still in the plane of its hinges, in which the plan could compute it
  const std::string drive = R"-(, "drives": [{"law": {"expression": "0.6*t^2"}}])-";
  open_door.erase(open_door.find(drive), drive.size());
  EXPECT_TRUE(holds(refused(open_door), "'door' can still turn about the axis (0, 0, 1)")) << refused(open_door);
}

// A crank as long as its rod folds flat when the slider passes the axle: there the slider may stay or go on.
TEST(InverseDynamics, stops_where_drives_leave_a_motion_free) {
  const std::string json = R"-({"analysis": {)-" + inverse(1.0, 0.125) + R"-(},
  "bodies": [{"name": "crank", "position": [0.25, 0, 0], "mass": 1, "inertia": [0.1, 0.1, 0.1]},
    {"name": "rod", "position": [0.75, 0, 0], "mass": 1, "inertia": [0.1, 0.1, 0.1]},
    {"name": "slider", "position": [1, 0, 0], "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "crank", "position": [0, 0, 0],
     "axis": [0, 0, 1], "drives": [{"law": {"expression": "3.14159265358979323846*t"}}]},
    {"name": "pin", "kind": "revolute", "first": "crank", "second": "rod", "position": [0.5, 0, 0], "axis": [0, 0, 1]},
    {"name": "wrist", "kind": "revolute", "first": "rod", "second": "slider", "position": [1, 0, 0],
     "axis": [0, 0, 1]},
    {"name": "rail", "kind": "prismatic", "first": "ground", "second": "slider", "position": [1, 0, 0],
     "axis": [1, 0, 0]}]})-";
  for (const char* form : {"local", "monolithic"}) {
    const Outcome out = support::run(scene_of(json, {std::string("/solver/form=") + form}));
    EXPECT_FALSE(out.ok()) << form;
    EXPECT_TRUE(holds(out.summary.cause, "at time 0.5")) << form << out.summary.cause;
  }
}

}  // namespace
}  // namespace bough::run
