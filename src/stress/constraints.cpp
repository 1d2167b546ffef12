/// Redundant and contradictory constraints, singular instants.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/parts.hpp"
#include "rigid_reference.hpp"

namespace bough::stress {

namespace {

constexpr scene::JointKind hinge = scene::JointKind::revolute;

/// A door of 1 m on a given number of hinges, all on one line: 5 rows are enough.
scene::Scene door(int hinges, double offset) {
  scene::Scene s;
  s.name = "door";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.bodies = {scene::make_body("door", 20.0, {{2.0, 3.0, 2.5}}, {{0.5, 0.0, 0.0}})};
  for (int k = 0; k < hinges; ++k) {
    const double z = 0.4 * k + offset;
    s.joints.push_back(scene::make_joint("hinge " + std::to_string(k), hinge, "", {{0, 0, z}}, "door", {{-0.5, 0, z}}));
    s.sensors.push_back(scene::make_joint_sensor("force " + std::to_string(k), "hinge " + std::to_string(k)));
  }
  s.sensors.push_back(scene::make_joint_sensor("angle", "hinge 0", scene::SensorKind::joint_angle));
  s.analysis.end_time = 1.0;
  s.analysis.step_size = 2e-3;
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-11;
  return s;
}

void redundant_hinges(Bench& bench) {
  const run::MemoryRun one = bench.run(door(1, 0.0), "one hinge");
  for (const int hinges : {2, 5, 20, 40}) {
    if (hinges > bench.shorten(40, 20)) break;
    const run::MemoryRun many = bench.run(door(hinges, 0.0), std::to_string(hinges) + " hinges");
    double angle = 0.0, force = 0.0, size = 0.0;
    for (std::size_t r = 0; r < one.rows.size(); ++r) {
      const auto of = [r](const run::MemoryRun& run, const std::string& c) {
        return run.rows.at(r).values[run.column(c)];
      };
      angle = std::max(angle, std::abs(of(many, "angle") - of(one, "angle")));
      for (const char* axis : {".fx", ".fy"}) {
        double sum = 0.0;
        for (int k = 0; k < hinges; ++k) sum += of(many, "force " + std::to_string(k) + axis);
        force = std::max(force, std::abs(sum - of(one, std::string("force 0") + axis)));
        size = std::max(size, std::abs(of(one, std::string("force 0") + axis)));
      }
    }
    bench.round_off_error("angle, " + std::to_string(hinges) + " hinges", angle, 1e-10);
    bench.round_off_error("sum of hinge forces, " + std::to_string(hinges) + " hinges", force / size, 1e-7);
    bench.figure("the run does not say that rows depend, " + std::to_string(hinges) + " hinges",
                 many.says("depend on others") ? 0.0 : 1.0, 0.0);
  }
}

/// Largest error of B0 at the reference's times, and of the values extrapolated from two steps.
void compare_four_bars(Bench& bench, int windows, const std::string& file, double end, double h, double limit,
                       double extrapolated_limit) {
  const ReferenceTable exact = reference_table(file);
  run::MemoryRun runs[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene s = scene::make_four_bars(windows);
    s.analysis.end_time = end;
    s.analysis.step_size = k == 0 ? h : 0.5 * h;
    s.analysis.tolerance = 1e-10;
    runs[k] = bench.run(s, std::to_string(windows) + " windows");
  }
  double fine = 0.0, extrapolated = 0.0;
  for (std::size_t r = 1; r < exact.times.size() && exact.times[r] <= end + 1e-9; ++r)
    for (int i = 0; i < 2; ++i) {
      const std::string column = i == 0 ? "B0.x" : "B0.y";
      const double e = exact.rows[r][exact.column(i == 0 ? "B0x" : "B0y")];
      const double a = value_at(runs[0], column, exact.times[r]), b = value_at(runs[1], column, exact.times[r]);
      fine = std::max(fine, std::abs(b - e));
      extrapolated = std::max(extrapolated, std::abs(b + (b - a) / 3.0 - e));
    }
  bench.error("place of the corner, finer step", fine, limit);
  bench.error("the same extrapolated", extrapolated, extrapolated_limit);
}

void four_bars_40(Bench& bench) {
  const double end = bench.shorten(10.0, 0.8);
  compare_four_bars(bench, 40, "A02_fourbar_N40.csv", end, bench.is_quick() ? 1e-2 : 4e-3, 2e-3, 2e-4);
}

void change_points(Bench& bench) {
  compare_four_bars(bench, 2, "A02_fourbar_N2.csv", bench.shorten(10.0, 3.0), 2e-3, 5e-4, 2e-5);
}

constexpr double crank = 0.2;

struct SliderCrank {
  double rod = 0.5;
  double crank_inertia = 0.02, rod_mass = 1.5, rod_inertia = 0.03, slider_mass = 2.0;  ///< crank: about its bearing

  /// Kinetic energy is inertia(angle) rate^2 / 2. Crank as long as the rod: they stay mirror images of each other.
  double inertia(double angle) const {
    const bool is_equal = rod == crank;
    const double s = std::sin(angle), c = std::cos(angle), sine = -crank * s / rod;
    const double cosine = is_equal ? c : std::sqrt(1.0 - sine * sine);
    const double turn = is_equal ? -1.0 : -crank * c / (rod * cosine);  // of the rod, per turn of the crank
    const double vx = -crank * s - 0.5 * rod * turn * sine, vy = crank * c + 0.5 * rod * turn * cosine;
    const double slider = -crank * s - rod * turn * sine;
    return crank_inertia + rod_mass * (vx * vx + vy * vy) + rod_inertia * turn * turn + slider_mass * slider * slider;
  }

  double angle_at(double angle_0, double rate_0, double end) const {
    const double energy = inertia(angle_0) * rate_0 * rate_0;
    return integrate(
        [&](double, const std::vector<double>& y) { return std::vector<double>{std::sqrt(energy / inertia(y[0]))}; },
        {angle_0}, end, 20000)[0];
  }

  /// In the plane z = 0, thrown at crank angle 0.3 with 10 rad/s. Ball joints leave no row redundant.
  scene::Scene scene() const {
    const double angle = 0.3, rate = 10.0, s = std::sin(angle), c = std::cos(angle), sine = -crank * s / rod,
                 cosine = std::sqrt(1.0 - sine * sine), lean = std::atan2(sine, cosine),
                 turn = -crank * c / (rod * cosine) * rate;
    const auto turned = [](double a) {
      return scene::Mat3{{std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1}};
    };
    scene::Scene out;
    out.name = "slider-crank";
    out.bodies = {
        scene::make_body("crank", 1.0, {{1e-3, 1e-2, crank_inertia - 0.01}}, {{0.5 * crank * c, 0.5 * crank * s, 0}}),
        scene::make_body("rod", rod_mass, {{1e-2, rod_inertia, rod_inertia}},
                         {{crank * c + 0.5 * rod * cosine, crank * s + 0.5 * rod * sine, 0}}),
        scene::make_body("slider", slider_mass, {{0.01, 0.01, 0.01}}, {{crank * c + rod * cosine, 0, 0}})};
    out.bodies[0].placement.pose.R = turned(angle);
    out.bodies[1].placement.pose.R = turned(lean);
    out.joints = {
        scene::make_joint("bearing", hinge, "", Vec3::zero(), "crank", {{-0.5 * crank, 0, 0}}),
        scene::make_joint("crank pin", scene::JointKind::spherical, "crank", {{0.5 * crank, 0, 0}}, "rod",
                          {{-0.5 * rod, 0, 0}}),
        scene::make_joint("wrist pin", scene::JointKind::spherical, "rod", {{0.5 * rod, 0, 0}}, "slider", Vec3::zero()),
        scene::make_joint("guide", scene::JointKind::prismatic, "", {{0, 0, 0}}, "slider", Vec3::zero())};
    out.joints[0].first.offset.R = turned(angle);
    // Axis 3 of the guide along x: columns are the axes.
    const scene::Mat3 along_x{{0, 0, 1, 1, 0, 0, 0, 1, 0}};
    out.joints[3].first.offset.R = out.joints[3].second.offset.R = along_x;
    const auto speed = [&out](const char* of, const Vec3& v, double w) {
      scene::InitialVelocity given;
      given.of = of;
      given.velocity = v;
      given.angular_velocity = {{0.0, 0.0, w}};
      out.initial_velocities.push_back(given);
    };
    speed("crank", {{-0.5 * crank * s * rate, 0.5 * crank * c * rate, 0}}, rate);
    speed("rod", {{-crank * s * rate - 0.5 * rod * turn * sine, crank * c * rate + 0.5 * rod * turn * cosine, 0}},
          turn);
    speed("slider", {{-crank * s * rate - rod * turn * sine, 0, 0}}, 0.0);
    out.sensors = {scene::make_joint_sensor("angle", "bearing", scene::SensorKind::joint_angle),
                   scene::make_point_sensor("slider", scene::SensorKind::position, "slider")};
    out.analysis.end_time = 1.5;
    out.analysis.spectral_radius = 0.9;
    out.analysis.tolerance = 1e-11;
    return out;
  }
};

void slider_cranks(Bench& bench, double rod, double limit) {
  SliderCrank model;
  model.rod = rod;
  scene::Scene s = model.scene();
  const double exact = model.angle_at(0.3, 10.0, s.analysis.end_time);
  double angle[2] = {};
  for (int k = 0; k < 2; ++k) {
    s.analysis.step_size = k == 0 ? 1e-3 : 5e-4;
    const run::MemoryRun run = bench.run(s);
    angle[k] = run.final("angle") + 0.3;
    bench.figure("slider off its place by the crank's angle",
                 k == 0 ? 0.0
                        : std::abs(run.final("slider.x") -
                                   (crank * std::cos(angle[k]) +
                                    (rod == crank ? crank * std::cos(angle[k])
                                                  : std::sqrt(rod * rod - std::pow(crank * std::sin(angle[k]), 2))))),
                 1e-9);
  }
  bench.tell("turns of the crank", exact / (2.0 * M_PI));
  bench.error("angle of the crank, finer step", std::abs(angle[1] - exact), 1e2 * limit);
  bench.error("the same extrapolated", std::abs(angle[1] + (angle[1] - angle[0]) / 3.0 - exact), limit);
}

void dead_centres(Bench& bench) { slider_cranks(bench, 0.5, 1e-5); }
void folded(Bench& bench) { slider_cranks(bench, crank, 1e-5); }

void contradiction(Bench& bench) {
  scene::Scene s = door(1, 0.0);
  s.joints[0].drives = {{"angle", false, laws::make_ramp(0.0, 1.0, 0.0, 1.0), {}}};
  s.joints.push_back(scene::make_joint("stop", scene::JointKind::fixed, "", {{0.5, 0, 0}}, "door", Vec3::zero()));
  bench.expect_refusal(s, {"stop", "hinge 0"});
}

void held_by_nothing(Bench& bench) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, 100, 100, 100), 1.0, 4, 1);
  s.joints = {scene::make_joint("ball", scene::JointKind::spherical, "", Vec3::zero(), "root", Vec3::zero())};
  s.sensors.pop_back();
  s.point_loads = {scene::make_load("tip", {{0.0, 1.0, 0.0}})};
  bench.expect_refusal(s, {"nothing but loads can hold"});
}

}  // namespace

void add_constraints(std::vector<Definition>& table) {
  table.push_back({"redundant_hinges", "constraints",
                   "a door on 2 to 40 hinges moves as on one to 1e-10 rad, the sum of their forces is that of the "
                   "one to 1e-7, and the run says that rows depend",
                   redundant_hinges});
  table.push_back({"four_bars_40", "constraints",
                   "40 windows of four-bars through flat positions, where all lose rank at once: the corner to 2e-3 m, "
                   "extrapolated to 2e-4 m over 10 s",
                   four_bars_40, StressStatus::holds, "", true});
  table.push_back({"change_points", "constraints",
                   "two windows pass their change points on their branch: to 5e-4 m, extrapolated to 2e-5 m",
                   change_points});
  table.push_back(
      {"dead_centres", "constraints",
       "a free slider-crank turns through its dead centres: angle after 1.5 s to 1e-3, extrapolated to 1e-5 "
       "rad",
       dead_centres});
  table.push_back({"folded_slider_crank", "constraints",
                   "the same with a rod as long as the crank, which folds at every half turn and may then turn another "
                   "way: it stays on its branch, to the same",
                   folded});
  table.push_back({"contradiction", "constraints",
                   "a driven hinge of something that is welded to the ground as well is refused, and both are named",
                   contradiction, StressStatus::refused});
  table.push_back({"held_by_nothing", "constraints",
                   "statics of a beam that can turn freely about a ball joint is refused: what nothing holds is named",
                   held_by_nothing, StressStatus::refused});
}

}  // namespace bough::stress
